// What a drive may do beside failing outright: hang in a state, lose its mode, tell nonsense, take long.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

#include "lcmtypes/error.h"
#include "tests/motion/axis.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

constexpr double kCounts = 1 << 24;  // a turn

bool alarmed(const AxisStatus& s) { return s.alarm != Alarm::kNone; }

TEST(AxisSupervision, TheDriveHearsTheQuickStopAtOnceNotWithTheNextCycle) {
  Axis axis;
  axis.bring_to_speed();
  axis.controller->emergency_stop("button");
  EXPECT_EQ(axis.line.heard.controlword, controlword::kQuickStop);
  EXPECT_EQ(axis.drive.state(), DriveState::kQuickStopActive);
}

TEST(AxisSupervision, ADriveThatHangsInItsQuickStopLosesItsVoltage) {
  Axis axis({.stop_timeout_s = 3});
  axis.bring_to_speed();
  axis.line.alter = [](DriveFeedback& f) { f.statusword = bits_of(DriveState::kQuickStopActive); };
  axis.controller->stop();
  axis.run_for(2.9);
  EXPECT_EQ(axis.line.heard.controlword, controlword::kQuickStop);
  EXPECT_EQ(axis.controller->status().state, AxisState::kStopping);
  axis.run_for(0.2);
  EXPECT_EQ(axis.line.heard.controlword, controlword::kDisableVoltage);
  EXPECT_EQ(axis.drive.state(), DriveState::kSwitchOnDisabled);
}

// The drive goes on at the rate it was given; so does the setpoint that its encoder is held against.
TEST(AxisSupervision, CyclesThatComeUnevenlyMakeNoFollowingError) {
  Axis axis;
  axis.bring_to_speed({.period_s = 4, .steady_s = 100, .rest_before_s = 0});
  axis.controller->reset_peak();
  for (int i = 0; i < 600; ++i) {
    const std::int64_t late_us = (i * 7919) % 20000;  // up to two periods
    axis.controller->cycle(axis.utime);
    axis.utime += kPeriod_us + late_us;
    axis.drive.advance(1e-6 * static_cast<double>(kPeriod_us + late_us));
  }
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone) << axis.controller->alarm_message();
  EXPECT_LT(axis.controller->status().peak_following_error_rad, 3e-3);  // 20 ms at 1.57 rad/s are 0.03
}

TEST(AxisSupervision, TurnsBeyondThe32BitsOfTheEncoder) {
  constexpr double kFine = 1 << 28;  // eight turns to the sign bit
  Axis axis({.counts_per_turn = kFine, .homing = true}, {.counts_per_turn = kFine, .initial_angle_rad = 0.5});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady, 30));
  const RotationProfile profile({.period_s = 2, .steady_s = 36, .rest_before_s = 0, .rest_after_s = 0.5});
  axis.controller->start(profile, axis.utime);
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.runs_finished == 1; }, 60))
      << axis.controller->alarm_message();
  EXPECT_NEAR(axis.controller->status().measured_rad, 20 * 2 * pi, 1e-3);
  // Homed again it stands at zero, not at a multiple of what the encoder's bits hold.
  axis.controller->stop();
  ASSERT_TRUE(axis.run_to(AxisState::kIdle));
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady, 30)) << axis.controller->alarm_message();
  EXPECT_NEAR(axis.controller->status().measured_rad, 0, 1e-4);
}

TEST(AxisSupervision, EveryRunBeginsWhereTheArmStands) {
  Axis axis({}, {.initial_angle_rad = 0.4});
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  const RotationProfile profile({.period_s = 3.5, .steady_s = 7, .rest_before_s = 0.1, .rate_drift = 0.1});
  const double turned_rad = profile.at(profile.duration_s()).angle_rad;
  for (int run = 1; run <= 2; ++run) {
    axis.controller->start(profile, axis.utime);
    ASSERT_TRUE(axis.run_until([&](const AxisStatus& s) { return s.runs_finished == run; }, 60))
        << axis.controller->alarm_message();
    EXPECT_NEAR(axis.controller->status().measured_rad, 0.4 + run * turned_rad, 1e-3);
  }
}

// As if a run had begun long ago: the first setpoint is far away.
TEST(AxisSupervision, NoSetpointBeyondTheLimitsEverReachesTheDrive) {
  Axis axis;
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  axis.run_for(0.1);
  const std::int32_t stands = axis.line.heard.target_position;
  axis.controller->start(RotationProfile({.period_s = 3, .rest_before_s = 0}), axis.utime - 15'000'000);
  ASSERT_TRUE(axis.run_until(
      [&](const AxisStatus& s) {
        EXPECT_LT(std::abs(axis.line.heard.target_position - stands), kCounts / 1000);
        return alarmed(s);
      },
      1));
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kRateLimit);
  EXPECT_NE(axis.controller->alarm_message().find("setpoint: "), std::string::npos)
      << axis.controller->alarm_message();
  ASSERT_TRUE(axis.run_to(AxisState::kLocked));
  EXPECT_TRUE(axis.stopped_and_off());
}

TEST(AxisSupervision, AMeasuredRateBeyondTheLimitStopsTheRun) {
  Axis axis({.limits = {.rate_radps = 2}});
  axis.bring_to_speed();
  axis.line.alter = [](DriveFeedback& f) {
    f.velocity = static_cast<std::int32_t>(2.3 / (2 * pi) * kCounts);
  };
  axis.step();
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kRateLimit);
  ASSERT_TRUE(axis.run_to(AxisState::kLocked));
  EXPECT_TRUE(axis.stopped_and_off());
}

TEST(AxisSupervision, ADriveWhoseTimeStandsStillHangs) {
  Axis axis;
  axis.bring_to_speed();
  const std::int64_t stuck_utime = axis.controller->status().feedback_utime;
  axis.line.alter = [=](DriveFeedback& f) { f.utime = stuck_utime; };
  ASSERT_TRUE(axis.run_until(alarmed, 0.1));
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kStaleFeedback);
  EXPECT_EQ(axis.controller->status().missed_exchanges, 3);
}

TEST(AxisSupervision, ADriveThatChangesItsModeHasLeftOperation) {
  Axis axis;
  axis.bring_to_speed();
  axis.line.alter = [](DriveFeedback& f) { f.mode = DriveMode::kProfileVelocity; };
  axis.step();
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kDriveLeftOperation);
}

TEST(AxisSupervision, ADriveThatDoesNotEnableIsGivenUp) {
  Axis axis({.enable_timeout_s = 1.5});
  axis.line.alter = [](DriveFeedback& f) { f.statusword = bits_of(DriveState::kReadyToSwitchOn); };
  axis.controller->enable();
  axis.run_for(1.4);
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone);
  axis.run_for(0.2);
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kEnableTimeout);
}

TEST(AxisSupervision, HomingThatFailsOrDoesNotEndIsAnAlarm) {
  for (const bool refused : {true, false}) {
    Axis axis({.homing_timeout_s = 30, .homing = true}, {.initial_angle_rad = 1});
    axis.line.alter = [=](DriveFeedback& f) {
      constexpr std::uint16_t kAttained = statusword::kHomingAttained;
      f.statusword = static_cast<std::uint16_t>(f.statusword & ~kAttained);
      if (refused) f.statusword |= statusword::kHomingError;
    };
    axis.controller->enable();
    ASSERT_TRUE(axis.run_to(AxisState::kHoming));
    axis.run_for(0.05);
    EXPECT_EQ(alarmed(axis.controller->status()), refused);
    axis.run_for(29.5);
    EXPECT_EQ(alarmed(axis.controller->status()), refused);
    axis.run_for(1);
    EXPECT_EQ(axis.controller->status().alarm, Alarm::kHomingFailed);
    EXPECT_TRUE(axis.stopped_and_off());
  }
}

TEST(AxisSupervision, ACycleTooLateIsAnAlarmWheneverTheDriveIsOn) {
  Axis axis;
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady));
  axis.utime += 80'000;
  axis.step();
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kDeadlineMissed);
}

TEST(AxisSupervision, AHoldThatTheLimitsForbidWaitsAndCanBeTakenBack) {
  const RotationProfile profile({.period_s = 4, .steady_s = 60, .rest_before_s = 0});
  const ProfilePeaks peaks = profile.peaks();
  for (const bool taken_back : {false, true}) {
    Axis axis({.limits = {peaks.rate_radps, peaks.accel_radps2, peaks.jerk_radps3}});
    axis.controller->enable();
    ASSERT_TRUE(axis.run_to(AxisState::kReady));
    axis.controller->start(profile, axis.utime);
    axis.run_for(4);  // the middle of the ramp: at the limit of acceleration
    axis.controller->hold();
    axis.run_for(0.1);
    EXPECT_EQ(axis.controller->status().hold, RunClock::State::kRunning);
    if (taken_back) axis.controller->resume();
    const bool slowed =
        axis.run_until([](const AxisStatus& s) { return s.hold != RunClock::State::kRunning; }, 30);
    EXPECT_EQ(slowed, !taken_back);
    EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone) << axis.controller->alarm_message();
  }
}

TEST(AxisSupervision, OneLostAnswerRightAfterAnAcknowledgementIsForgiven) {
  Axis axis;
  axis.bring_to_speed();
  axis.drive.faults.silent = true;
  ASSERT_TRUE(axis.run_to(AxisState::kLocked, 15));
  axis.controller->acknowledge();
  axis.step();
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone) << axis.controller->alarm_message();
}

TEST(AxisSupervision, TellsTheTorqueAndItsLimit) {
  Axis axis;
  axis.bring_to_speed();
  axis.line.alter = [](DriveFeedback& f) {
    f.torque_permille = -1500;
    f.statusword |= statusword::kInternalLimit;
  };
  axis.step();
  EXPECT_NEAR(axis.controller->status().torque_ratio, -1.5, 1e-12);
  EXPECT_TRUE(axis.controller->status().torque_limited);
  axis.drive.faults.jam_Nm = 500;
  ASSERT_TRUE(axis.run_until(alarmed, 5));
  EXPECT_NE(axis.controller->alarm_message().find("at its torque limit"), std::string::npos)
      << axis.controller->alarm_message();
}

TEST(AxisSupervision, RefusesCountsThatMakeRatesBeyond32Bits) {
  SimulatedDrive drive;
  EXPECT_THROW(AxisController(drive, {.counts_per_turn = 1 << 30, .limits = {.rate_radps = 20}}), UserError);
}

TEST(AxisSupervision, EveryAlarmSaysSomethingElse) {
  std::set<std::string_view> texts;
  const int last = static_cast<int>(Alarm::kEmergencyStop);
  for (int alarm = 0; alarm <= last; ++alarm) texts.insert(text_of(static_cast<Alarm>(alarm)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(last + 1));
}

}  // namespace
}  // namespace waverig::motion
