// Accelerometer: an analog three-axis part, from true specific force to output voltage.
//
// The effects, in this order, each with a zero switch in the settings it is drawn from:
//   1 misalignment, scale, bias   Lee 2014, eq. (1): M f + b
//   2 nonlinearity                quadratic and cubic, zero at no input; six positions cannot see the cubic
//   part 3 temperature drift           of the zero-g output and of the sensitivity, linear about 25 degC 4
//   bias instability            first-order Gauss-Markov 5 bandwidth                   first-order low-pass
//   per axis 6 saturation                  of the output stage 7 white noise                 stated one-sided
//   density; drawn as the mean over a counting interval
// All in m/s^2 referred to the input through the nominal sensitivity; the output voltage is that times
// sensitivity.
#pragma once
#include <cstdint>

#include "motion/kinematics/frames.h"
#include "motion/kinematics/random.h"
#include "rig/sensors/slow_effects.h"

namespace waverig::rig {

// How parts of a type scatter: standard deviations per axis, unless named otherwise.
struct AccelerometerSettings {
  double sensitivity_VpMps2 = 1;  // nominal
  double range_mps2 = 0;          // output stage limit; 0: none
  double noise_density_mps2 = 0;  // per sqrt(Hz), one-sided
  double bias_sigma_mps2 = 0;
  double scale_sigma = 0;
  double misalignment_sigma = 0;  // off-diagonal elements of M
  double nonlinearity_sigma = 0;  // largest deviation from the best straight line, of full-scale span
  double nonlinearity_limit = 0;  // the data sheet's, of full-scale span: no unit is drawn beyond it
  double bias_drift_sigma_mps2pdegC = 0;
  double scale_drift_sigma_pdegC = 0;
  double instability_sigma_mps2 = 0;
  double instability_time_s = 100;
  Vector3d bandwidth_Hz = Vector3d::Zero();  // 0: none
};

// Freescale MMA7331LC in its 4 g range at 2.8 V. Noise, drifts, nonlinearity and bandwidth are those of its
// family (MMA7361L); scale, misalignment and bias scatter as on the published unit.
AccelerometerSettings mma7331lc();

// One drawn unit: the simulator's truth, for the report of a calibration only.
struct AccelerometerParameters {
  Matrix3d M = Matrix3d::Identity();
  Vector3d bias_mps2 = Vector3d::Zero();
  Vector3d quadratic_pmps2 = Vector3d::Zero();  // f + quadratic f^2 + cubic f^3
  Vector3d cubic_pmps4 = Vector3d::Zero();
  Vector3d bias_drift_mps2pdegC = Vector3d::Zero();
  Vector3d scale_drift_pdegC = Vector3d::Zero();
};

AccelerometerParameters draw_accelerometer(const AccelerometerSettings& settings, std::uint64_t seed);

// The unit published in Lee 2014, section 2, with no other imperfection.
AccelerometerParameters lee2014_accelerometer();

class Accelerometer {
 public:
  // interval_s: of one sample; slow effects and noise advance once a sample.
  Accelerometer(const AccelerometerSettings& settings, const AccelerometerParameters& unit, double interval_s,
                std::uint64_t noise_seed);

  // Begins a counting interval: temperature and instability take their values for it, its mean noise is
  // drawn.
  void begin_interval(double temperature_degC);

  // The output dt_s after the last call, f_B changing linearly between: input-referred, without noise.
  const Vector3d& respond(const Vector3d& f_B, double dt_s);

  const Vector3d& interval_noise_mps2() const { return noise_; }
  const AccelerometerParameters& unit() const { return unit_; }

 private:
  AccelerometerSettings settings_;
  AccelerometerParameters unit_;
  Vector3d time_constant_s_ = Vector3d::Zero();
  double noise_sigma_;
  RandomStream noise_stream_, instability_stream_;
  GaussMarkov instability_;
  Matrix3d M_now_;  // with this interval's temperature and instability
  Vector3d bias_now_;
  Vector3d decay_ = Vector3d::Zero();  // of the low-pass over decay_dt_s_
  double decay_dt_s_ = 0;
  bool started_ = false;
  Vector3d input_ = Vector3d::Zero(), filtered_ = Vector3d::Zero(), output_ = Vector3d::Zero();
  Vector3d noise_ = Vector3d::Zero();
};

}  // namespace waverig::rig
