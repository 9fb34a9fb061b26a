// Attitude of a floating body: a tilt out of the horizontal, given as a rotation vector in N, then its
// heading.
#pragma once
#include "motion/kinematics/body_motion.h"

namespace waverig::motion {

struct Tilt {
  Vector3d phi_N = Vector3d::Zero();       // rad; (0, pitch, 0) at heading 0 lifts the bow
  Vector3d phi_rate_N = Vector3d::Zero();  // rad/s
  double heading_rad = 0;
  double heading_rate_radps = 0;
};

// q_NB = exp(phi) Rz(heading), with the angular rate that belongs to it exactly.
inline void set_attitude(BodyMotion& motion, const Tilt& tilt) {
  const Quaterniond heading(Eigen::AngleAxisd(tilt.heading_rad, Vector3d::UnitZ()));
  motion.q_NB = quaternion_exp(tilt.phi_N) * heading;

  // Right Jacobian of SO(3): exp(phi)^T d/dt exp(phi) = [J_r phi_rate]x, Chirikjian 2012, eq. (10.86).
  const double angle = tilt.phi_N.norm(), a2 = angle * angle;
  const double k1 = angle < 1e-3 ? 0.5 - a2 / 24 : (1 - std::cos(angle)) / a2;
  const double k2 = angle < 1e-3 ? 1.0 / 6 - a2 / 120 : (angle - std::sin(angle)) / (a2 * angle);
  const Vector3d cross = tilt.phi_N.cross(tilt.phi_rate_N);
  const Vector3d rate = tilt.phi_rate_N - k1 * cross + k2 * tilt.phi_N.cross(cross);
  motion.w_NB_B = heading.conjugate() * rate + Vector3d(0, 0, tilt.heading_rate_radps);
}

}  // namespace waverig::motion
