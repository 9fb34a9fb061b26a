// StaticPose: the sensor at rest in one of the six positions of a calibration, each body axis up and down.
#pragma once
#include <cstdint>

#include "estimator/calibration/six_position.h"
#include "motion/kinematics/body_motion.h"

namespace waverig::rig {

using estimator::kSixPositions;
using estimator::StaticPose;

// fixture_error_B: by how much the fixture misses the position, a small rotation vector (rad) in the body
// frame.
inline BodyMotion pose_motion(const StaticPose& pose, const Vector3d& fixture_error_B, std::int64_t utime) {
  BodyMotion motion;
  motion.utime = utime;
  const Vector3d up_B = pose.sign * Vector3d::Unit(pose.axis);
  motion.q_NB = Quaterniond::FromTwoVectors(up_B, -Vector3d::UnitZ()) * quaternion_exp(fixture_error_B);
  return motion;
}

}  // namespace waverig::rig
