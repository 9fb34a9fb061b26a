#include "rig/mechanism/rotating_arm.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "lcmtypes/error.h"
#include "rig/mechanism/static_pose.h"

namespace waverig::rig {
namespace {

constexpr double kStep = 2e-3;
constexpr std::int64_t kStep_us = 2000;

RotatingArmSettings bare_arm() {
  RotatingArmSettings s;
  s.lever_arm_G_m.setZero();
  s.mounting = {};
  return s;
}

motion::ShaftState turning(double t, double period_s) {
  const double w = 2 * std::numbers::pi / period_s;
  return {w * t, w, 0};
}

// A shaft whose rate swells and ebbs, so that every derivative is at work.
motion::ShaftState surging(double t) {
  return {0.9 * t + 0.4 * std::sin(1.1 * t), 0.9 + 0.44 * std::cos(1.1 * t), -0.484 * std::sin(1.1 * t)};
}

std::vector<BodyMotion> motions(RotatingArm& arm, double duration_s,
                                const std::function<motion::ShaftState(double)>& shaft) {
  std::vector<BodyMotion> all{arm.advance(shaft(0), 0, 0)};
  for (std::int64_t k = 1; static_cast<double>(k) * kStep <= duration_s; ++k)
    all.push_back(arm.advance(shaft(static_cast<double>(k) * kStep), kStep, k * kStep_us));
  return all;
}

TEST(RotatingArm, LiftsTheSensorAsRadiusTimesSine) {
  RotatingArmSettings s = bare_arm();
  s.pendulum_length_m = 0;
  s.azimuth_rad = 30 * kDegree;
  RotatingArm arm(s, 0.5);
  EXPECT_NEAR(heave_m(arm.advance({0, 0, 0}, 0, 0)), 0, 1e-15);
  const BodyMotion top = arm.advance({std::numbers::pi / 2, 0, 0}, kStep, kStep_us);
  EXPECT_NEAR(heave_m(top), 0.5, 1e-15);
  EXPECT_EQ(top.utime, kStep_us);
  const BodyMotion level = arm.advance({0, 0, 0}, kStep, 2 * kStep_us);
  EXPECT_NEAR(level.position_N.x(), 0.5 * std::cos(30 * kDegree), 1e-15);
  EXPECT_NEAR(level.position_N.y(), 0.5 * std::sin(30 * kDegree), 1e-15);
  EXPECT_NEAR(euler_of(level.q_NB).yaw_rad, 30 * kDegree, 1e-12);
}

TEST(RotatingArm, TellsAccelerationVelocityAndRateThatAreDerivativesOfEachOther) {
  for (const bool forced : {false, true}) {
    RotatingArmSettings s;
    s.azimuth_rad = 1.1;
    s.arm_sag_rad = 0.02;
    s.bearing_damping = 0.05;
    s.lever_arm_G_m << 0.05, 0.02, 0.15;
    s.mounting = {0.1, -0.2, 0.3};
    if (forced) s.forced_tilt_rad = 0.2;
    RotatingArm arm(s, 0.6);
    const auto m = motions(arm, 12, surging);
    for (std::size_t k = 1; k + 1 < m.size(); ++k) {
      const double two_steps = 2 * kStep;
      EXPECT_LT(((m[k + 1].position_N - m[k - 1].position_N) / two_steps - m[k].velocity_N).norm(), 1e-4);
      EXPECT_LT(((m[k + 1].velocity_N - m[k - 1].velocity_N) / two_steps - m[k].acceleration_N).norm(), 1e-3);
      const Quaterniond turned = m[k - 1].q_NB.conjugate() * m[k + 1].q_NB;
      EXPECT_LT((2 * turned.vec() / two_steps - m[k].w_NB_B).norm(), 1e-3);
      EXPECT_NEAR(m[k].q_NB.norm(), 1, 1e-12);
    }
  }
}

TEST(RotatingArm, GondolaDecaysAsADampedPendulumOfSmallAngle) {
  RotatingArmSettings s = bare_arm();
  s.pendulum_length_m = 0.25;
  s.pendulum_damping = 0.1;
  RotatingArm arm(s, 0.01);
  const double w0 = std::sqrt(s.gravity_mps2 / 0.25), wd = w0 * std::sqrt(1 - 0.01), decay = 0.1 * w0;
  arm.advance({0, 2, 0}, 0, 0);  // turning: it hangs aside
  const double start = arm.swing_rad();
  EXPECT_NEAR(start, 0.01 * 4 / s.gravity_mps2, 1e-4 * start);
  arm.advance({0, 0, 0}, 1e-9, 0);  // and stops
  for (int k = 1; k <= 2000; ++k) {
    arm.advance({0, 0, 0}, kStep, k * kStep_us);
    const double t = k * kStep;
    const double expected = start * std::exp(-decay * t) * (std::cos(wd * t) + decay / wd * std::sin(wd * t));
    EXPECT_NEAR(arm.swing_rad(), expected, 1e-5 * start + 1e-9);
  }
}

TEST(RotatingArm, GondolaAnswersTheArmAsADrivenPendulumOfSmallAngle) {
  RotatingArmSettings s = bare_arm();
  s.pendulum_length_m = 0.25;
  s.pendulum_damping = 0.15;
  constexpr double kRadius = 0.002, kPeriod = 2;
  RotatingArm arm(s, kRadius);
  const auto m = motions(arm, 40, [](double t) { return turning(t, kPeriod); });
  double largest = 0;
  for (std::size_t k = m.size() - 1000; k < m.size(); ++k)
    largest = std::max(largest, euler_of(m[k].q_NB).pitch_rad);
  const double w = 2 * std::numbers::pi / kPeriod, w0 = std::sqrt(s.gravity_mps2 / 0.25);
  const double expected = kRadius * w * w / 0.25 / std::hypot(w0 * w0 - w * w, 2 * 0.15 * w0 * w);
  EXPECT_NEAR(largest, expected,
              0.005 * expected);  // the closed form leaves out vertical acceleration, 0.2 % of g
}

// At rest against the drag: g sin(swing) / l = 2 zeta_b w0 arm', the way the arm turns.
TEST(RotatingArm, BearingFrictionDragsTheGondolaRoundWithTheArm) {
  RotatingArmSettings s = bare_arm();
  s.bearing_damping = 0.1;
  s.pendulum_damping = 0.5;
  const double w0 = std::sqrt(s.gravity_mps2 / s.pendulum_length_m);
  for (const double period_s : {6.0, -6.0}) {
    RotatingArm arm(s, 0);
    motions(arm, 20, [&](double t) { return turning(t, period_s); });
    EXPECT_NEAR(std::sin(arm.swing_rad()), 2 * 0.1 * 2 * std::numbers::pi / period_s / w0, 1e-9);
  }
}

TEST(RotatingArm, FollowsApparentGravityWhenTheWaveIsLong) {
  RotatingArm arm(bare_arm(), 0.5);
  const auto m = motions(arm, 60, [](double t) { return turning(t, 12); });
  for (std::size_t k = 5000; k < m.size(); ++k) {
    const Vector3d f = specific_force_B(m[k], {0, 0, kStandardGravity});
    EXPECT_LT(std::hypot(f.x(), f.y()), 0.03 * 0.137);  // of the horizontal acceleration, 0.137 m/s^2
  }
}

TEST(RotatingArm, ForcedTiltHasItsAmplitudeAndPhase) {
  RotatingArmSettings s = bare_arm();
  s.forced_tilt_rad = 5 * kDegree;
  s.forced_tilt_phase_rad = 40 * kDegree;
  RotatingArm arm(s, 0.5);
  const BodyMotion m = arm.advance({50 * kDegree, 0.5, 0}, kStep, 0);
  EXPECT_NEAR(euler_of(m.q_NB).pitch_rad, 5 * kDegree, 1e-12);
  EXPECT_NEAR(m.w_NB_B.norm(), 0, 1e-12);  // at its turning point
}

TEST(RotatingArm, SagLowersTheLevelArmAndLeavesTheUprightOne) {
  RotatingArmSettings s = bare_arm();
  s.pendulum_length_m = 0;
  s.arm_sag_rad = 0.01;
  RotatingArm arm(s, 1);
  EXPECT_NEAR(heave_m(arm.advance({0, 0, 0}, 0, 0)), -std::sin(0.01), 1e-15);
  EXPECT_NEAR(heave_m(arm.advance({std::numbers::pi / 2, 0, 0}, 0, 0)), 1, 1e-15);
}

TEST(RotatingArm, RefusesWhatIsNoLength) {
  EXPECT_THROW(RotatingArm({}, -0.1), UserError);
  EXPECT_THROW(RotatingArm({}, std::numeric_limits<double>::quiet_NaN()), UserError);
  RotatingArmSettings s;
  s.pendulum_length_m = -1;
  EXPECT_THROW(RotatingArm(s, 0.5), UserError);
}

TEST(StaticPose, PutsGravityOnOneAxis) {
  for (const StaticPose& pose : kSixPositions) {
    const Vector3d f = specific_force_B(pose_motion(pose, Vector3d::Zero(), 0), {0, 0, 9.8});
    EXPECT_LT((f - pose.sign * 9.8 * Vector3d::Unit(pose.axis)).norm(), 1e-12) << pose.name;
  }
  const Vector3d missed = specific_force_B(pose_motion(kSixPositions[4], {0.01, 0, 0}, 0), {0, 0, 9.8});
  EXPECT_NEAR(missed.y(), 9.8 * std::sin(0.01), 1e-12);  // f x error: z up, turned about x
}

}  // namespace
}  // namespace waverig::rig
