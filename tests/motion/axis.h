// An axis in virtual time: the controller, the simulated drive that it commands, and the line between them.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "motion/axis_controller.h"
#include "motion/simulated_drive.h"

namespace waverig::motion {

inline constexpr std::int64_t kPeriod_us = 10000;

// Hands everything on, and can tell the controller something else than the drive said.
struct Line final : Drive {
  explicit Line(SimulatedDrive& far_end) : drive(far_end) {}
  DriveFeedback exchange(const DriveCommand& command) override {
    heard = command;
    DriveFeedback feedback = drive.exchange(command);
    if (alter) alter(feedback);
    return feedback;
  }
  SimulatedDrive& drive;
  DriveCommand heard;  // the last command
  std::function<void(DriveFeedback&)> alter;
};

struct Axis {
  explicit Axis(const AxisSettings& settings = {}, const SimulatedDriveSettings& drive_settings = {})
      : drive(drive_settings), controller(std::make_unique<AxisController>(line, settings)) {}

  const AxisStatus& step() {
    const AxisStatus& status = controller->cycle(utime);
    utime += kPeriod_us;
    drive.advance(1e-6 * kPeriod_us);
    return status;
  }
  // True when `done` came true within the time.
  bool run_until(const std::function<bool(const AxisStatus&)>& done, double most_s) {
    for (std::int64_t end = utime + std::llround(most_s * 1e6); utime < end;)
      if (done(step())) return true;
    return false;
  }
  bool run_to(AxisState state, double most_s = 10) {
    return run_until([&](const AxisStatus& s) { return s.state == state; }, most_s);
  }
  void run_for(double time_s) {
    run_until([](const AxisStatus&) { return false; }, time_s);
  }
  // In the middle of a run at full rate.
  void bring_to_speed(const ProfileSettings& profile = {.period_s = 4, .rest_before_s = 0}) {
    controller->enable();
    ASSERT_TRUE(run_to(AxisState::kReady));
    controller->start(RotationProfile(profile), utime);
    run_for(15);
    ASSERT_EQ(controller->status().state, AxisState::kRunning);
    ASSERT_GT(std::abs(drive.shaft().rate_radps), 1);
  }
  bool stopped_and_off() const {
    return drive.shaft().rate_radps == 0 && drive.state() != DriveState::kOperationEnabled &&
           drive.state() != DriveState::kQuickStopActive && drive.state() != DriveState::kFaultReaction;
  }

  SimulatedDrive drive;
  Line line{drive};
  std::unique_ptr<AxisController> controller;
  std::int64_t utime = 1'000'000;
};

}  // namespace waverig::motion
