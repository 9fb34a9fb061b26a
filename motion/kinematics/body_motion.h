// BodyMotion: what a rigid body does at one instant, and what an ideal inertial sensor on it feels.
#pragma once
#include <cstdint>

#include "motion/kinematics/frames.h"

namespace waverig {

struct BodyMotion {
  std::int64_t utime = 0;
  Vector3d position_N = Vector3d::Zero();      // m, of the sensor, from the orbit's centre or mean position
  Vector3d velocity_N = Vector3d::Zero();      // m/s
  Vector3d acceleration_N = Vector3d::Zero();  // m/s^2
  Quaterniond q_NB = Quaterniond::Identity();  // body to navigation
  Vector3d w_NB_B = Vector3d::Zero();          // rad/s, angular rate of B against N, in B
};

// Lee-HK: an accelerometer measures f = a - g. g_N in m/s^2, positive down: (0, 0, g).
inline Vector3d specific_force_B(const BodyMotion& motion, const Vector3d& g_N) {
  return motion.q_NB.conjugate() * (motion.acceleration_N - g_N);
}

inline double heave_m(const BodyMotion& motion) { return -motion.position_N.z(); }

}  // namespace waverig
