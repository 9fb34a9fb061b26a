// RotatingArm: an arm that turns in a vertical plane and carries a gondola; the gondola swings. What comes
// out is the motion of the sensor inside the gondola: the truth of a run.
//
// The arm's plane is spanned by the horizontal direction of its azimuth and by up. At shaft angle 0 the arm
// lies horizontal, pointing along the azimuth; a growing angle lifts the sensor: heave = r sin(angle). The
// gondola is a damped plane pendulum on the accelerating pivot, its bearing parallel to the shaft:
//   swing'' = -(a_along cos swing + (g + a_up) sin swing) / l - 2 zeta w0 swing' - 2 zeta_b w0 (swing' -
//   arm'),
// swing positive towards the azimuth (a positive pitch). With forced tilt the gondola is held instead and
// tilts with the arm: swing = forced_tilt sin(angle + phase), at the wave's frequency and exactly known.
#pragma once
#include <cstdint>

#include "motion/kinematics/body_motion.h"
#include "motion/shaft.h"

namespace waverig::rig {

struct RotatingArmSettings {
  double azimuth_rad = 0;                  // where the arm points at angle 0, from north to east
  double gravity_mps2 = kStandardGravity;  // at the place of the rig
  double arm_sag_rad = 0;                  // flex: how far the horizontal arm sags under its own weight
  double pendulum_length_m = 0.25;         // of the equivalent point pendulum; 0: the gondola is held level
  double pendulum_damping = 0.15;          // zeta, against the air
  double bearing_damping = 0;              // zeta_b, against the turning arm
  double forced_tilt_rad = 0;              // other than 0: the gondola is forced to this amplitude
  double forced_tilt_phase_rad = 0;
  Vector3d lever_arm_G_m{0.01, 0.005,
                         0.10};  // from pivot to sensor, gondola frame (x along the azimuth, z down)
  Euler mounting{0.3 * kDegree, -0.2 * kDegree, 0.5 * kDegree};  // of the sensor in the gondola
};

class RotatingArm {
 public:
  // Throws UserError where a length is negative or not finite.
  RotatingArm(const RotatingArmSettings& settings, double radius_m);

  // The shaft as it is dt_s after the last call; utime of the new instant. dt_s = 0 sets the first instant,
  // with the gondola hanging at rest. Position is told from where the sensor hangs when the arm's tip is at
  // the orbit's centre.
  const BodyMotion& advance(const motion::ShaftState& shaft, double dt_s, std::int64_t utime);

  double swing_rad() const { return swing_.angle_rad; }
  double arm_angle_rad() const { return arm_angle_rad_; }

 private:
  struct Swing {
    double angle_rad = 0, rate_radps = 0, accel_radps2 = 0;
  };
  struct Pivot {  // acceleration in the arm's plane and the arm's rate
    double along_mps2 = 0, up_mps2 = 0, rate_radps = 0;
  };
  double swing_accel(double angle_rad, double rate_radps, const Pivot& pivot) const;
  void swing_freely(const Pivot& before, const Pivot& after, double dt_s);
  void swing_forced(const motion::ShaftState& arm);

  RotatingArmSettings settings_;
  double radius_m_;
  double cos_azimuth_, sin_azimuth_, inverse_length_, natural_radps_;
  Quaterniond q_azimuth_, q_GB_;
  Matrix3d R_BG_;
  bool free_;
  bool started_ = false;
  Pivot pivot_;
  Swing swing_;
  double arm_angle_rad_ = 0;
  BodyMotion motion_;
};

}  // namespace waverig::rig
