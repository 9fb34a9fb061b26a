// Whatever fails, the drive stops and the alarm says why.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "lcmtypes/error.h"
#include "tests/motion/axis.h"

namespace waverig::motion {
namespace {

// Every way in which a run can fail: what is done to it, and the alarm that must follow.
struct Failure {
  const char* name;
  Alarm alarm;
  std::function<void(Axis&)> inject;
};

class EveryFailure : public testing::TestWithParam<Failure> {};

TEST_P(EveryFailure, RaisesItsAlarmAndLeavesTheDriveStopped) {
  Axis axis;
  axis.bring_to_speed();
  GetParam().inject(axis);
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.alarm != Alarm::kNone; }, 5));
  EXPECT_EQ(axis.controller->status().alarm, GetParam().alarm) << axis.controller->alarm_message();
  EXPECT_FALSE(axis.controller->alarm_message().empty());
  ASSERT_TRUE(axis.run_to(AxisState::kLocked, 15));
  axis.run_for(3);
  EXPECT_TRUE(axis.stopped_and_off()) << name_of(axis.drive.state()) << ' ' << axis.drive.shaft().rate_radps;

  // Locked until acknowledged; the first cause stays the one that is told.
  EXPECT_THROW(axis.controller->enable(), UserError);
  EXPECT_THROW(axis.controller->start(RotationProfile({}), axis.utime), UserError);
  EXPECT_EQ(axis.controller->status().alarm, GetParam().alarm);

  // Mended and acknowledged, it runs again.
  axis.drive.faults = {};
  axis.controller->acknowledge();
  axis.run_for(0.1);
  axis.controller->enable();
  ASSERT_TRUE(axis.run_to(AxisState::kReady)) << axis.controller->alarm_message();
}

TEST_P(EveryFailure, StopsTheDriveEvenIfTheControllerDiesRightAfterTheAlarm) {
  Axis axis;
  axis.bring_to_speed();
  GetParam().inject(axis);
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.alarm != Alarm::kNone; }, 5));
  axis.controller.reset();
  axis.drive.advance(5);
  EXPECT_TRUE(axis.stopped_and_off()) << name_of(axis.drive.state()) << ' ' << axis.drive.shaft().rate_radps;
}

INSTANTIATE_TEST_SUITE_P(
    AxisController, EveryFailure,
    testing::Values(
        Failure{"Jam", Alarm::kFollowingError, [](Axis& a) { a.drive.faults.jam_Nm = 500; }},
        Failure{"BrokenCoupling", Alarm::kFollowingError, [](Axis& a) { a.drive.faults.torque_ratio = 0; }},
        Failure{"Runaway", Alarm::kFollowingError, [](Axis& a) { a.drive.faults.extra_rate_radps = 2; }},
        Failure{"EncoderStuck", Alarm::kFollowingError, [](Axis& a) { a.drive.faults.encoder_stuck = true; }},
        Failure{"DriveSilent", Alarm::kDriveSilent, [](Axis& a) { a.drive.faults.silent = true; }},
        Failure{"DriveHung", Alarm::kWrongEcho, [](Axis& a) { a.drive.faults.frozen = true; }},
        Failure{"LateAnswers", Alarm::kWrongEcho, [](Axis& a) { a.drive.faults.late = true; }},
        Failure{"DriveFault", Alarm::kDriveFault, [](Axis& a) { a.drive.faults.error_code = 0x2310; }},
        Failure{"DriveSwitchedOffByOthers", Alarm::kDriveLeftOperation,
                [](Axis& a) { a.drive.exchange({.controlword = controlword::kDisableVoltage}); }},
        Failure{"LateCycle", Alarm::kDeadlineMissed,
                [](Axis& a) {
                  a.utime += 80'000;
                  a.drive.advance(0.08);
                }},
        Failure{"TimeRunsBack", Alarm::kDeadlineMissed, [](Axis& a) { a.utime -= 30'000; }},
        Failure{"EmergencyStop", Alarm::kEmergencyStop,
                [](Axis& a) { a.controller->emergency_stop("button"); }}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(AxisFailures, ControllerKilledWithoutGoodbyeIsCaughtByTheDrivesWatchdog) {
  Axis axis;
  axis.bring_to_speed();
  axis.drive.advance(5);  // no cycle any more
  EXPECT_TRUE(axis.stopped_and_off());
  EXPECT_EQ(axis.drive.state(), DriveState::kFault);
}

TEST(AxisFailures, DestructorStopsARunningAxis) {
  Axis axis;
  axis.bring_to_speed();
  axis.controller.reset();
  EXPECT_EQ(axis.drive.state(), DriveState::kQuickStopActive);
  axis.drive.advance(2);
  EXPECT_TRUE(axis.stopped_and_off());
  EXPECT_EQ(axis.drive.state(), DriveState::kSwitchOnDisabled);  // not the watchdog's fault
}

TEST(AxisFailures, OrderedStopEndsIdleWithoutAlarm) {
  Axis axis;
  axis.bring_to_speed();
  axis.controller->stop();
  ASSERT_TRUE(axis.run_to(AxisState::kIdle));
  EXPECT_TRUE(axis.stopped_and_off());
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone);
}

TEST(AxisFailures, ASingleLostAnswerIsForgiven) {
  Axis axis;
  axis.bring_to_speed();
  for (int i = 0; i < 5; ++i) {
    axis.drive.faults.silent = true;
    axis.step();
    axis.drive.faults.silent = false;
    axis.run_for(0.2);
  }
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kNone);
  EXPECT_EQ(axis.controller->status().missed_exchanges, 5);
  EXPECT_LT(axis.controller->status().peak_following_error_rad, 5e-3);
}

TEST(AxisFailures, RestartedAfterACrashTakesAMovingFaultedDriveBack) {
  Axis axis;
  axis.bring_to_speed();
  axis.drive.advance(3);  // crash: watchdog, fault
  ASSERT_EQ(axis.drive.state(), DriveState::kFault);
  axis.controller = std::make_unique<AxisController>(axis.drive, AxisSettings{});
  axis.utime += 3'000'000;
  ASSERT_TRUE(axis.run_to(AxisState::kLocked));  // a latched fault does not look healthy
  EXPECT_EQ(axis.controller->status().alarm, Alarm::kDriveFault);
  EXPECT_NE(axis.controller->alarm_message().find("8130h"), std::string::npos);
  axis.controller->acknowledge();
  axis.run_for(0.1);
  axis.controller->enable();
  EXPECT_TRUE(axis.run_to(AxisState::kReady)) << axis.controller->alarm_message();
}

TEST(AxisFailures, FollowingErrorAlarmTellsTheNumbersAndItsPeakCanBeReset) {
  Axis axis({.max_following_error_rad = 0.01});
  axis.bring_to_speed();
  axis.drive.faults.jam_Nm = 500;
  ASSERT_TRUE(axis.run_until([](const AxisStatus& s) { return s.alarm != Alarm::kNone; }, 5));
  EXPECT_EQ(axis.controller->alarm_message().substr(0, 25), "alarm 1, following error:")
      << axis.controller->alarm_message();
  EXPECT_GT(axis.controller->status().peak_following_error_rad, 0.01);
  axis.controller->reset_peak();
  EXPECT_EQ(axis.controller->status().peak_following_error_rad, 0);
}

}  // namespace
}  // namespace waverig::motion
