// StaticPose: the sensor at rest in one of the six positions of a calibration, each body axis up and down.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "motion/kinematics/body_motion.h"

namespace waverig::rig {

struct StaticPose {
  int axis = 2;      // 0, 1, 2: x, y, z of the body
  double sign = -1;  // +1: the axis points up, so that its specific force is +g
  std::string_view name;
};

// Lee 2014, Table 1.
inline constexpr std::array<StaticPose, 6> kSixPositions{{{0, +1, "x up"},
                                                          {0, -1, "x down"},
                                                          {1, +1, "y up"},
                                                          {1, -1, "y down"},
                                                          {2, +1, "z up"},
                                                          {2, -1, "z down"}}};

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
