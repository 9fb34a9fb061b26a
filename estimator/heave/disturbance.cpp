#include "estimator/heave/disturbance.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kCorrelation_s = 1.0;         // of what a tilt error does to the vertical
constexpr double kSaturatedNoise_m2ps3 = 1.0;  // several m/s^2 for tenths of a second
constexpr double kSlowestSea_radps = 0.2;

double square(double x) { return x * x; }

}  // namespace

AttitudeSettings attitude_settings(const SensorKnowledge& sensor) {
  AttitudeSettings s;
  s.gravity_mps2 = sensor.gravity_mps2;
  s.gyro_bias_sigma_radps = std::max(s.gyro_bias_sigma_radps, 2 * sensor.gyro_bias_sigma_radps);
  s.accel_bias_sigma_mps2 = sensor.accel_bias_sigma_mps2;
  return s;
}

double disturbance_m2ps3(const AttitudeSample& attitude, std::int32_t flags, double gravity_mps2) {
  const double tilt2 = square(attitude.tilt_sigma_rad);
  const double noise = tilt2 * attitude.a_N.head<2>().squaredNorm() + square(gravity_mps2 * tilt2);
  return kCorrelation_s * noise + (flags & flag::kSaturation ? kSaturatedNoise_m2ps3 : 0.0);
}

double systematic_variance_m2(const SeaModel& sea, const Motion& motion, const SensorKnowledge& s) {
  const double per_lean =
      std::hypot(s.accel_bias_sigma_mps2, s.accel_misalignment_sigma_rad * s.gravity_mps2);
  const double w2 = square(std::max(sea.mean_frequency_radps, kSlowestSea_radps));
  return sea.heave_variance_m2() * (square(s.accel_scale_sigma) + motion.tilt_variance_rad2) +
         motion.leaning_variance_rad2 * square(per_lean / w2);
}

}  // namespace waverig::estimator
