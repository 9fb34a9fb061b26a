#include "estimator/heave/disturbance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kTiltCorrelation_s = 0.3;     // of what a tilt error does to the vertical
constexpr double kOffsetCorrelation_s = 0.05;  // of what a turned offset does to it
constexpr double kSteadyTilt_rad = 0.25 * kDegree;
constexpr double kSaturatedNoise_m2ps3 = 1.0;  // several m/s^2 for tenths of a second
constexpr double kSlowestSea_radps = 0.2;
constexpr double kImprobable = 3;  // standard deviations

double turned_mps2(const Motion& motion, const SensorKnowledge& sensor) {
  return std::max(
      std::hypot(sensor.accel_bias_sigma_mps2, sensor.accel_misalignment_sigma_rad * sensor.gravity_mps2),
      std::abs(motion.excess_mps2));
}

}  // namespace

AttitudeSettings attitude_settings(const SensorKnowledge& sensor) {
  AttitudeSettings s;
  s.gravity_mps2 = sensor.gravity_mps2;
  s.gyro_bias_sigma_radps = std::max(s.gyro_bias_sigma_radps, 2 * sensor.gyro_bias_sigma_radps);
  s.accel_bias_sigma_mps2 = sensor.accel_bias_sigma_mps2;
  return s;
}

double accel_noise_m2ps3(const SensorKnowledge& sensor) {
  return square(attitude_settings(sensor).accel_noise_mps2_rthz) / 2;  // one-sided to two-sided
}

double disturbance_m2ps3(const AttitudeSample& attitude, std::int32_t flags, double gravity_mps2) {
  // A settled attitude errs slowly: what it lets in lies at the waves' own frequencies and makes no drift.
  const double tilt2 = std::max(square(attitude.tilt_sigma_rad) - square(kSteadyTilt_rad), 0.0);
  const double noise = tilt2 * attitude.a_N.head<2>().squaredNorm() + square(gravity_mps2 * tilt2 / 2);
  return kTiltCorrelation_s * noise + (flags & flag::kSaturation ? kSaturatedNoise_m2ps3 : 0.0);
}

double turned_offset_m2ps3(const AttitudeSample& attitude, const Motion& motion,
                           const SensorKnowledge& sensor) {
  const Vector3d down_B = attitude.q_NB.conjugate() * Vector3d::UnitZ();
  return kOffsetCorrelation_s * square(turned_mps2(motion, sensor)) * (down_B - motion.down_B).squaredNorm();
}

Eigen::Array2d gyro_scale_leaks_mps2(const AttitudeSample& attitude, const Motion& motion,
                                     const Vector3d& f_B) {
  const Vector3d down_B = attitude.q_NB.conjugate() * Vector3d::UnitZ();
  const Vector3d torn_B = f_B.cross(down_B);  // down . (e_i x f) is its i-th component
  return {-(down_B.y() - motion.down_B.y()) * torn_B.x(), (down_B.x() - motion.down_B.x()) * torn_B.y()};
}

void Motion::follow(const AttitudeSample& attitude, double share) {
  const Vector3d now_B = attitude.q_NB.conjugate() * Vector3d::UnitZ();
  down_B += share * (now_B - down_B);
  leaning_variance_rad2 += share * ((now_B - down_B).squaredNorm() - leaning_variance_rad2);
  tilt_variance_rad2 += share * (square(attitude.tilt_sigma_rad) - tilt_variance_rad2);
  excess_mps2 += share * (attitude.a_N.z() - excess_mps2);
}

double offset_sigma_mps2(const SensorKnowledge& s) {
  return std::hypot(s.accel_bias_sigma_mps2, s.accel_scale_sigma * s.gravity_mps2, s.gravity_sigma_mps2);
}

double offset_sigma_mps2(const Motion& motion, const SeaModel& sea, double elapsed_s,
                         const SensorKnowledge& s) {
  const double known = offset_sigma_mps2(s);
  // A mean acceleration is the change of speed over the time.
  const double speed_mps = sea.mean_frequency_radps * std::sqrt(sea.heave_variance_m2());
  const double chance = std::hypot(known, std::numbers::sqrt2 * speed_mps / elapsed_s);
  return std::abs(motion.excess_mps2) > kImprobable * chance ? std::hypot(known, motion.excess_mps2) : known;
}

double systematic_variance_m2(const SeaModel& sea, const Motion& motion, const SensorKnowledge& s) {
  const double w2 = square(std::max(sea.mean_frequency_radps, kSlowestSea_radps));
  return sea.heave_variance_m2() * (square(s.wave_scale_sigma()) + motion.tilt_variance_rad2) +
         motion.leaning_variance_rad2 * square(turned_mps2(motion, s) / w2);
}

}  // namespace waverig::estimator
