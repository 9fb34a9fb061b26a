#include "motion/axis_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "tests/motion/axis.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

TEST(AxisController, EnablesTheDriveAndHoldsItsPlace) {
  Axis axis({}, {.initial_angle_rad = 0.4});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady, 0.1));
  axis.run_for(5);
  EXPECT_EQ(axis.drive.state(), DriveState::kOperationEnabled);
  EXPECT_NEAR(axis.drive.shaft().angle_rad, 0.4, 1e-5);
}

TEST(AxisController, PlaysAProfileAndEndsReadyAfterWholeTurns) {
  Axis axis;
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  const RotationProfile profile({.period_s = 6, .steady_s = 60});
  axis.controller->start(profile, axis.utime);
  const std::int64_t begin = axis.utime;
  axis.controller->reset_peak();
  double worst = 0;
  ASSERT_TRUE(axis.run_until(
      [&](const AxisStatus& s) {
        const double expected = profile.at(1e-6 * static_cast<double>(s.utime - begin)).angle_rad;
        worst = std::max(worst, std::abs(s.measured_rad - expected));
        return s.runs_finished == 1;
      },
      profile.duration_s() + 1));
  EXPECT_LT(worst, 1e-3);  // measured follows the closed form at equal times, with no lag of a cycle
  EXPECT_EQ(axis.controller->status().state, AxisState::kReady);
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone);
  EXPECT_NEAR(axis.drive.shaft().angle_rad, 12 * 2 * pi, 1e-4);
  EXPECT_LT(axis.controller->status().peak_following_error_rad, 1e-3);
  EXPECT_GT(axis.controller->status().peak_following_error_rad, 0);
}

TEST(AxisController, TellsThePhasesOfTheRunAtTheirTimes) {
  Axis axis;
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  const RotationProfile profile({.period_s = 4, .steady_s = 20, .rest_before_s = 3, .rest_after_s = 1});
  const std::int64_t begin = axis.utime + 500'000;
  axis.controller->start(profile, begin);
  axis.step();
  int compared = 0;
  axis.run_until(
      [&](const AxisStatus& s) {
        if (s.state != AxisState::kRunning) return true;
        EXPECT_EQ(s.phase, profile.at(1e-6 * static_cast<double>(s.utime - begin)).phase) << s.utime - begin;
        ++compared;
        return false;
      },
      100);
  EXPECT_GT(compared, 3900);
}

TEST(AxisController, StaysInsideTheLimitsOverRandomSettings) {
  RandomStream random(4, "controller test");
  int played = 0, refused = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const AxisLimits limits{random.uniform(0.5, 7), random.uniform(0.2, 5), random.uniform(0.2, 10)};
    Axis axis({.limits = limits});
    axis.controller->enable();
    ASSERT_TRUE(axis.run_to(AxisState::kReady));
    const RotationProfile profile({.period_s = random.uniform(1, 20),
                                   .steady_s = 20,
                                   .ramp_periods = 1 + trial % 3,
                                   .rest_before_s = random.uniform(0, 1),
                                   .direction = trial % 2 == 0 ? 1 : -1,
                                   .rate_modulation = random.uniform(0, 0.1),
                                   .modulation_cycles = trial % 4});
    try {
      axis.controller->start(profile, axis.utime);
    } catch (const UserError&) {
      EXPECT_TRUE(exceeds(limits, profile));
      ++refused;
      continue;
    }
    ++played;
    double fastest = 0;
    axis.run_until(
        [&](const AxisStatus& s) {
          fastest = std::max(fastest, std::abs(axis.drive.shaft().rate_radps));
          return s.runs_finished == 1;
        },
        200);
    EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone) << axis.controller->alarm_message();
    EXPECT_EQ(axis.controller->status().runs_finished, 1);
    EXPECT_LT(fastest, limits.rate_radps + 0.02);
  }
  EXPECT_GT(played, 8);
  EXPECT_GT(refused, 3);
}

TEST(AxisController, RefusesAProfileBeyondTheLimitsWithAReason) {
  Axis axis({.limits = {.rate_radps = 1}});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  try {
    axis.controller->start(RotationProfile({.period_s = 3}), axis.utime);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(),
                 "axis: cannot start: angular rate 2.094 rad/s is beyond the axis limit 1 rad/s");
  }
  EXPECT_EQ(axis.controller->status().state, AxisState::kReady);
}

TEST(AxisController, RefusesRequestsOutOfPlace) {
  Axis axis;
  EXPECT_THROW(axis.controller->start(RotationProfile({}), 0), UserError);
  EXPECT_THROW(axis.controller->hold(), UserError);
  EXPECT_THROW(axis.controller->resume(), UserError);
  EXPECT_THROW(axis.controller->acknowledge(), UserError);
  axis.controller->enable();
  EXPECT_THROW(axis.controller->enable(), UserError);
}

TEST(AxisController, HomesWithinTheLimitsFromAnyAngle) {
  for (const double start_rad : {-2.9, -0.3, 0.0, 1.7, 3.1, 9.0}) {
    Axis axis({.homing = true}, {.initial_angle_rad = start_rad, .initial_offset_rad = 0.77});
    axis.controller->enable();
    double fastest = 0;
    ASSERT_TRUE(axis.run_until(
        [&](const AxisStatus& s) {
          fastest = std::max(fastest, std::abs(axis.drive.shaft().rate_radps));
          return s.state == AxisState::kReady;
        },
        60))
        << start_rad << axis.controller->alarm_message();
    axis.run_for(1);
    EXPECT_NEAR(axis.controller->status().measured_rad, 0, 1e-5);
    EXPECT_NEAR(std::remainder(axis.drive.shaft().angle_rad, 2 * pi), 0, 1e-5);
    EXPECT_LE(fastest, 0.21);
  }
}

TEST(AxisController, RateLimitHoldsDuringHomingToo) {
  Axis axis({.limits = {.rate_radps = 0.1}, .homing = true},
            {.initial_angle_rad = 2, .homing_rate_radps = 0.2});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kLocked, 20));
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kRateLimit);
  EXPECT_TRUE(axis.stopped_and_off());
}

TEST(AxisController, AccelerationLimitHoldsDuringHomingToo) {
  Axis axis({.limits = {.accel_radps2 = 0.3}, .homing = true}, {.initial_angle_rad = 2, .homing_radps2 = 2});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kLocked, 20));
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kAccelLimit);
}

TEST(AxisController, FeedHoldStopsTheArmInsideTheLimitsAndResumeGoesOnWhereItStood) {
  const AxisLimits limits{.rate_radps = 2, .accel_radps2 = 1, .jerk_radps3 = 2};
  Axis axis({.limits = limits});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  const RotationProfile profile({.period_s = 4, .steady_s = 40, .rest_before_s = 0});
  axis.controller->start(profile, axis.utime);
  axis.run_for(15);
  axis.controller->hold();
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.hold == RunClock::State::kHeld; }, 30));
  axis.run_for(20);
  EXPECT_NEAR(axis.drive.shaft().rate_radps, 0, 1e-3);
  const double held_rad = axis.drive.shaft().angle_rad;
  axis.run_for(5);
  EXPECT_NEAR(axis.drive.shaft().angle_rad, held_rad, 1e-4);
  axis.controller->resume();
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.runs_finished == 1; }, 200));
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone) << axis.controller->alarm_message();
  EXPECT_NEAR(axis.drive.shaft().angle_rad, 12 * 2 * pi, 1e-3);
}

TEST(AxisController, CheckModeRunsAllButTheMotion) {
  Axis axis({.check_mode = true});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  const RotationProfile profile({.period_s = 4, .steady_s = 20});
  axis.controller->start(profile, axis.utime);
  double farthest = 0;
  ASSERT_TRUE(axis.run_until(
      [&](const AxisStatus& s) {
        farthest = std::max(farthest, s.setpoint_rad);
        return s.runs_finished == 1;
      },
      100));
  EXPECT_NEAR(farthest, 7 * 2 * pi, 1e-9);
  EXPECT_EQ(axis.drive.shaft().angle_rad, 0);
  EXPECT_EQ(axis.drive.state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone);
}

TEST(AxisController, RunsAreBitIdentical) {
  const auto play = [] {
    Axis axis;
    axis.bring_to_speed();
    axis.run_for(5);
    return axis.controller->status();
  };
  const AxisStatus a = play(), b = play();
  EXPECT_EQ(a.measured_rad, b.measured_rad);
  EXPECT_EQ(a.peak_following_error_rad, b.peak_following_error_rad);
  EXPECT_EQ(a.torque_ratio, b.torque_ratio);
}

TEST(AxisController, RefusesSettingsThatMakeNoController) {
  SimulatedDrive drive;
  EXPECT_THROW(AxisController(drive, {.control_period_s = 0}), UserError);
  EXPECT_THROW(AxisController(drive, {.limits = {.rate_radps = -1}}), UserError);
  EXPECT_THROW(AxisController(drive, {.max_cycle_gap_s = 0.001}), UserError);
}

}  // namespace
}  // namespace waverig::motion
