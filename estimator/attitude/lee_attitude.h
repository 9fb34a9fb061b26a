// LeeAttitude: roll and pitch after Lee 2014, eqs (2)-(9): a linear Kalman filter whose state is the
// quaternion.
//
// The state equation (6) is linear because the angular rate stands in the transition matrix; the measurement
// is the roll and pitch of the specific force taken as if at rest, eqs (3), (4), turned into a quaternion by
// eq (7) with the filter's own yaw. There is no gyro bias in the state: a bias leans the frame by bias * time
// constant.
#pragma once
#include <Eigen/Core>

#include "estimator/types.h"

namespace waverig::estimator {

struct LeeAttitudeSettings {
  double gravity_mps2 = kStandardGravity;
  double gyro_noise_radps_rthz = 0.025 * kDegree;            // one-sided density of the data sheet
  double accel_noise_mps2_rthz = 350e-6 * kStandardGravity;  // one-sided density of the data sheet
};

// Lee 2014, eqs (3), (4): roll and pitch of a sensor at rest. Angles beyond what |f| = g allows are clamped.
Euler rest_attitude(const Vector3d& f_B, double gravity_mps2);

// Levelling: f_N = Ry(theta) Rx(phi) f_B; at rest it gives (0, 0, -g). Departs from Lee 2014, eqs (8) and
// (9), which print the inverse rotations and so double the tilt instead of taking it out.
Vector3d levelled(const Vector3d& f_B, double roll_rad, double pitch_rad);

class LeeAttitude {
 public:
  explicit LeeAttitude(const LeeAttitudeSettings& settings) : settings_(settings) {}
  // dt_s since the last sample; 0 for the first, which starts the filter at its rest attitude.
  const Quaterniond& update(const Vector3d& f_B, const Vector3d& w_NB_B, double dt_s);
  const Quaterniond& q_NB() const { return q_; }

 private:
  LeeAttitudeSettings settings_;
  Quaterniond q_ = Quaterniond::Identity();
  Eigen::Matrix4d P_ = Eigen::Matrix4d::Zero();
  bool started_ = false;
};

}  // namespace waverig::estimator
