// The truth on the bus: what the mechanism did, for the evaluator and the recorder alone.
#pragma once
#include <waverig/truth_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/bus.h"
#include "lcmtypes/channels.h"
#include "motion/kinematics/body_motion.h"

namespace waverig::rig {

inline void publish_truth(Bus& bus, const BodyMotion& motion, std::int64_t seq, double arm_angle_rad) {
  truth_t m{};
  m.utime = motion.utime;
  m.seq = seq;
  m.heave_m = heave_m(motion);
  m.heave_rate_mps = -motion.velocity_N.z();
  m.north_m = motion.position_N.x();
  m.east_m = motion.position_N.y();
  estimator::put(motion.q_NB, m.quat_NB);
  m.arm_angle_rad = arm_angle_rad;
  bus.publish(channel::kTruth, m);
}

}  // namespace waverig::rig
