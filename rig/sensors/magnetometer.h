// Magnetometer: a digital three-axis part in the Earth's field and in what the rig adds to it, to its own
// counts.
//
// The effects, in this order, each with a zero switch:
//   1 Earth's field                 total, dip (positive down), declination (positive east): the place's
//   2 the motor's field             dipoles at the hub; seen from the sensor it changes as the arm turns
//   3 soft iron, scale, misalignment, hard iron     S m + h, of what is mounted beside the part
//   4 white noise                   per conversion
//   5 quantisation and range        in its counts; a part that knows an overflow code shows it
//   6 output rate                   between conversions the last counts stand
#pragma once
#include <cstdint>

#include "motion/kinematics/body_motion.h"
#include "motion/kinematics/random.h"

namespace waverig::rig {

// The field of the place. The default is that of Cho's simulation, 50 deg of dip, at 50 uT.
struct EarthFieldSettings {
  double total_uT = 50;
  double dip_rad = 50 * kDegree;
  double declination_rad = 0;
};
Vector3d earth_field_N_uT(const EarthFieldSettings& settings);

struct MotorFieldSettings {
  Vector3d hub_N_m = Vector3d::Zero();              // of the motor, from where BodyMotion::position_N is zero
  double azimuth_rad = 0;                           // of the arm's plane
  Vector3d stator_moment_N_Am2 = Vector3d::Zero();  // stands with the pedestal
  Vector3d rotor_moment_Am2 =
      Vector3d::Zero();  // turns with the arm: along it, across it in its plane, along the axis
};
// At a place in N. No field within 1 cm of the hub, where a dipole is no model of a motor.
Vector3d motor_field_N_uT(const MotorFieldSettings& settings, const Vector3d& position_N_m);

// How parts of a type scatter: standard deviations per axis, unless named otherwise.
struct MagnetometerSettings {
  EarthFieldSettings earth{};
  MotorFieldSettings motor{};
  double lsb_uT = 0;                // one count; 0: no quantisation, counts of 1 nT
  std::int32_t largest_count = 0;   // 0: no limit
  std::int32_t overflow_count = 0;  // shown beyond it; 0: the count stands at its limit
  double noise_uT = 0;              // rms, per conversion
  double output_rate_Hz = 0;        // 0: a conversion a sample
  double hard_iron_sigma_uT = 0;
  double scale_sigma = 0;      // diagonal of S
  double soft_iron_sigma = 0;  // off-diagonal elements of S
};

// Freescale MAG3110: +-1000 uT, 0.1 uT a count, 80 Hz; noise 0.25 uT rms. Iron of a small board.
MagnetometerSettings mag3110();
// Honeywell HMC5883L at its default gain: 1090 counts a gauss, 12 bit, -4096 on overflow, 2 mG of noise, 75
// Hz.
MagnetometerSettings hmc5883l();

// What one count is worth, whether quantised or not.
double magnetometer_count_uT(const MagnetometerSettings& settings);

// One mounted unit: the simulator's truth.
struct MagnetometerParameters {
  Matrix3d soft_iron = Matrix3d::Identity();
  Vector3d hard_iron_uT = Vector3d::Zero();
};
MagnetometerParameters draw_magnetometer(const MagnetometerSettings& settings, std::uint64_t seed);

class Magnetometer {
 public:
  Magnetometer(const MagnetometerSettings& settings, const MagnetometerParameters& unit,
               std::uint64_t noise_seed);

  // Counts at the motion's utime, which must not go back.
  Eigen::Vector3i sample(const BodyMotion& motion);

  // Whether an axis stood at its limit in the last conversion.
  bool saturated() const { return saturated_; }
  const MagnetometerParameters& unit() const { return unit_; }

 private:
  void convert(const BodyMotion& motion);

  MagnetometerSettings settings_;
  MagnetometerParameters unit_;
  Vector3d earth_N_uT_;
  double counts_per_uT_;
  RandomStream noise_stream_;
  std::int64_t interval_us_, next_utime_ = 0;
  bool started_ = false, saturated_ = false;
  Eigen::Vector3i counts_ = Eigen::Vector3i::Zero();
};

}  // namespace waverig::rig
