// Gyroscope: a digital three-axis part, from true angular rate to its own counts.
//
// The effects, in this order, each with a zero switch in the settings it is drawn from:
//   1 misalignment, scale, zero-rate offset   M w + b
//   2 temperature drift of the offset         linear about 25 degC
//   3 g-sensitivity                           offset proportional to specific force
//   4 bias instability                        first-order Gauss-Markov
//   5 white noise                             stated one-sided density, per sample
//   6 saturation and quantisation             in its counts
#pragma once
#include <cstdint>

#include "motion/kinematics/frames.h"
#include "motion/kinematics/random.h"
#include "rig/sensors/slow_effects.h"

namespace waverig::rig {

// How parts of a type scatter: standard deviations per axis, unless named otherwise.
struct GyroscopeSettings {
  double lsb_radps = 0;            // one count; 0: no quantisation, counts of 1e-6 rad/s
  std::int32_t largest_count = 0;  // 0: no saturation
  double noise_density_radps = 0;  // per sqrt(Hz), one-sided
  double offset_sigma_radps = 0;
  double offset_limit_radps = 0;  // no unit is drawn beyond it; 0: none
  double scale_sigma = 0;
  double misalignment_sigma = 0;
  double offset_drift_sigma_radpspdegC = 0;
  double g_sensitivity_sigma_s_rad_m = 0;  // rad/s per m/s^2
  double instability_sigma_radps = 0;
  double instability_time_s = 200;
};

// FXAS21000: 14 bit, range 200, 400, 800 or 1600 deg/s; noise and offset are its sibling's (FXAS21002C).
// Throws UserError for another range.
GyroscopeSettings fxas21000(double range_degps = 200);

// What one count is worth, whether quantised or not.
double gyroscope_count_radps(const GyroscopeSettings& settings);

// One drawn unit: the simulator's truth.
struct GyroscopeParameters {
  Matrix3d M = Matrix3d::Identity();
  Vector3d offset_radps = Vector3d::Zero();
  Vector3d offset_drift_radpspdegC = Vector3d::Zero();
  Vector3d g_sensitivity_s_rad_m = Vector3d::Zero();  // along each axis, rad/s per m/s^2
};

GyroscopeParameters draw_gyroscope(const GyroscopeSettings& settings, std::uint64_t seed);

struct GyroscopeReading {
  Eigen::Vector3i counts = Eigen::Vector3i::Zero();
  bool saturated = false;
};

class Gyroscope {
 public:
  Gyroscope(const GyroscopeSettings& settings, const GyroscopeParameters& unit, double interval_s,
            std::uint64_t noise_seed);

  // One sample: rate and specific force at the instant of sampling. Once an interval.
  GyroscopeReading sample(const Vector3d& w_B_radps, const Vector3d& f_B, double temperature_degC);

 private:
  GyroscopeSettings settings_;
  GyroscopeParameters unit_;
  double noise_sigma_, counts_per_radps_;
  RandomStream noise_stream_, instability_stream_;
  GaussMarkov instability_;
};

}  // namespace waverig::rig
