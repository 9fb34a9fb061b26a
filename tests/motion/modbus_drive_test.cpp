// Over real transports, TCP on the loopback and RTU on a pseudo-terminal; the drive's time is virtual all the
// same.
#include "motion/modbus_drive.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <thread>

#include "lcmtypes/error.h"
#include "motion/axis_controller.h"
#include "motion/modbus_registers.h"
#include "tests/motion/modbus_bench.h"
#include "tests/motion/pty_pair.h"

namespace waverig::motion {
namespace {

constexpr std::int64_t kPeriod_us = 10000;

// One control period against the bench.
const AxisStatus& step(AxisController& controller, std::atomic<std::int64_t>& now_us) {
  const AxisStatus& status = controller.cycle(now_us);
  now_us += kPeriod_us;
  return status;
}

void bring_to_speed(AxisController& controller, std::atomic<std::int64_t>& now_us) {
  controller.enable();
  for (int i = 0; i < 100 && controller.status().state != AxisState::kReady; ++i) step(controller, now_us);
  ASSERT_EQ(controller.status().state, AxisState::kReady) << controller.alarm_message();
  controller.start(RotationProfile({.period_s = 2, .ramp_periods = 1, .rest_before_s = 0}), now_us);
  for (int i = 0; i < 300; ++i) step(controller, now_us);
  ASSERT_EQ(controller.status().state, AxisState::kRunning) << controller.alarm_message();
}

TEST(ModbusRegisters, CarryEveryValueThereAndBack) {
  constexpr auto kLow = std::numeric_limits<std::int32_t>::min(),
                 kHigh = std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t value : {kLow, -1, 0, 1, 65535, 65536, kHigh}) {
    const DriveCommand c{.sequence = 65535,
                         .controlword = 0x8f,
                         .mode = DriveMode::kHoming,
                         .target_position = value,
                         .target_velocity = -value / 3};
    const DriveCommand c2 = registers::decode_command(registers::encode(c));
    EXPECT_EQ(c2.sequence, c.sequence);
    EXPECT_EQ(c2.controlword, c.controlword);
    EXPECT_EQ(c2.mode, c.mode);
    EXPECT_EQ(c2.target_position, c.target_position);
    EXPECT_EQ(c2.target_velocity, c.target_velocity);
    const DriveFeedback f{.utime = 1'700'000'000'123'456,
                          .sequence = 7,
                          .statusword = 0x1637,
                          .mode = DriveMode::kCyclicPosition,
                          .position = value,
                          .velocity = -value / 3,
                          .torque_permille = -1234,
                          .error_code = 0x8611};
    const DriveFeedback f2 = registers::decode_feedback(registers::encode(f));
    EXPECT_EQ(f2.utime, f.utime);
    EXPECT_EQ(f2.position, f.position);
    EXPECT_EQ(f2.velocity, f.velocity);
    EXPECT_EQ(f2.torque_permille, f.torque_permille);
    EXPECT_EQ(f2.error_code, f.error_code);
  }
}

TEST(ModbusDrive, ARunOverTcpIsBitIdenticalToOneInProcess) {
  SimulatedDrive direct;
  AxisController reference(direct, {});
  Bench bench;
  ModbusDrive remote(patient(bench.port()));
  AxisController controller(remote, {});
  const RotationProfile profile({.period_s = 2, .steady_s = 4, .rest_before_s = 0.1, .rest_after_s = 0.1});
  for (int i = 0; i < 1300; ++i) {
    if (i == 5) {
      reference.enable();
      controller.enable();
    }
    if (i == 20) {
      reference.start(profile, bench.now_us);
      controller.start(profile, bench.now_us);
    }
    const AxisStatus& expected = reference.cycle(bench.now_us);
    direct.advance(1e-6 * kPeriod_us);
    const AxisStatus& status = step(controller, bench.now_us);
    ASSERT_EQ(status.measured_rad, expected.measured_rad) << i << controller.alarm_message();
    ASSERT_EQ(status.statusword, expected.statusword) << i;
    ASSERT_EQ(status.feedback_utime, expected.feedback_utime) << i;
  }
  EXPECT_EQ(controller.status().runs_finished, 1);
}

TEST(ModbusDrive, ASilentDriveRaisesTheAlarmAndEndsStopped) {
  Bench bench;
  ModbusDrive remote({.port = bench.port(), .response_timeout_s = 0.3});
  AxisController controller(remote, {});
  bring_to_speed(controller, bench.now_us);
  bench.rest();
  bench.drive.faults.silent = true;
  bench.begin();
  for (int i = 0; i < 10 && controller.status().alarm == Alarm::kNone; ++i) step(controller, bench.now_us);
  EXPECT_EQ(controller.status().alarm, Alarm::kDriveSilent) << controller.alarm_message();
  bench.now_us += 5'000'000;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  bench.rest();
  bench.drive.advance(5);
  EXPECT_EQ(bench.drive.shaft().rate_radps, 0);
  EXPECT_EQ(bench.drive.state(), DriveState::kFault);  // its own watchdog
}

TEST(ModbusDrive, ALateReplyOverTcpIsNeverTakenForTheNext) {
  Bench bench;
  ModbusDrive remote({.port = bench.port(), .response_timeout_s = 0.2});
  remote.exchange({.sequence = 1});
  bench.stall_ms = 500;
  EXPECT_THROW(remote.exchange({.sequence = 2}), std::runtime_error);
  DriveFeedback feedback;
  for (int i = 0; i < 50 && feedback.sequence == 0; ++i) {
    try {
      feedback = remote.exchange({.sequence = 3});
    } catch (const std::runtime_error&) {  // the server still sleeps
    }
  }
  EXPECT_EQ(feedback.sequence, 3);
  EXPECT_EQ(remote.exchange({.sequence = 4}).sequence, 4);
}

TEST(ModbusDrive, ARestartedServerIsFoundAgain) {
  auto bench = std::make_unique<Bench>();
  const int port = bench->port();
  ModbusDrive remote(patient(port));
  EXPECT_EQ(remote.exchange({.sequence = 1}).sequence, 1);
  bench.reset();
  EXPECT_THROW(remote.exchange({.sequence = 2}), std::runtime_error);
  EXPECT_THROW(remote.exchange({.sequence = 3}), std::runtime_error);
  bench = std::make_unique<Bench>(patient(port));
  EXPECT_EQ(remote.exchange({.sequence = 4}).sequence, 4);
}

TEST(ModbusDrive, AKilledClientLeavesTheDriveStopped) {
  SimulatedDrive drive;
  std::int64_t now_us = 0;
  ModbusDriveServer server(drive, patient(), [&] { return now_us; });
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {  // a controller that is killed in the middle of a run
    try {
      ModbusDrive remote(patient(server.port()));
      AxisController controller(remote, {});
      std::atomic<std::int64_t> time_us = 0;
      bring_to_speed(controller, time_us);
      for (;;) step(controller, time_us);
    } catch (...) {
      _exit(1);
    }
  }
  std::uint16_t last_sequence = 0;
  for (int i = 0; i < 100'000 && drive.shaft().rate_radps < 2; ++i) {
    server.serve(1000);
    const std::uint16_t sequence = drive.observe().sequence;
    if (sequence != last_sequence) now_us += kPeriod_us;  // the drive's time goes with the exchanges
    last_sequence = sequence;
  }
  EXPECT_GE(drive.shaft().rate_radps, 2);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (int i = 0; i < 300; ++i) {
    now_us += kPeriod_us;
    server.serve(0);
  }
  EXPECT_EQ(drive.shaft().rate_radps, 0);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(drive.observe().error_code, 0x8130);
}

TEST(ModbusDrive, SomeoneWhoOnlyReadsDoesNotFeedTheWatchdog) {
  Bench bench;
  ModbusDrive remote({.port = bench.port(), .response_timeout_s = 0.5});
  {
    AxisController controller(remote, {});
    bring_to_speed(controller, bench.now_us);
    bench.rest();
    bench.drive.faults.silent = true;  // the controller's goodbye gets lost
    bench.begin();
  }
  bench.rest();
  bench.drive.faults.silent = false;
  EXPECT_EQ(bench.drive.state(), DriveState::kOperationEnabled);
  bench.begin();
  const ModbusContext reader = make_modbus_context(patient(bench.port()));
  ASSERT_EQ(modbus_connect(reader.get()), 0);
  registers::FeedbackWords words{};
  for (int i = 0; i < 400; ++i) {
    bench.now_us += kPeriod_us;
    ASSERT_EQ(modbus_read_registers(reader.get(), registers::kFeedbackAddress, registers::kFeedbackCount,
                                    words.data()),
              registers::kFeedbackCount);
  }
  const DriveFeedback seen = registers::decode_feedback(words);
  EXPECT_EQ(state_of(seen.statusword), DriveState::kFault);
  EXPECT_EQ(seen.error_code, 0x8130);
  bench.rest();
  EXPECT_EQ(bench.drive.shaft().rate_radps, 0);
}

TEST(ModbusRtu, ControllerTurnsTheArmOverASerialLine) {
  PtyPair cable;
  ModbusLinkSettings client = patient(), server = patient();
  client.device = cable.end(0);
  server.device = cable.end(1);
  Bench bench(server);
  ModbusDrive remote(client);
  AxisController controller(remote, {});
  bring_to_speed(controller, bench.now_us);
  controller.stop();
  for (int i = 0; i < 300 && controller.status().state != AxisState::kIdle; ++i)
    step(controller, bench.now_us);
  EXPECT_EQ(controller.status().state, AxisState::kIdle);
  EXPECT_EQ(controller.status().missed_exchanges, 0);
  bench.rest();
  EXPECT_GT(bench.drive.shaft().angle_rad, 3);
  EXPECT_EQ(bench.drive.shaft().rate_radps, 0);
}

TEST(ModbusRtu, ALateReplyIsToldByItsSequenceAndGoneAfterOneExchange) {
  PtyPair cable;
  Bench bench({.device = cable.end(1), .response_timeout_s = 10, .byte_timeout_s = 1});
  ModbusDrive remote({.device = cable.end(0), .response_timeout_s = 0.5, .byte_timeout_s = 0.2});
  EXPECT_EQ(remote.exchange({.sequence = 1}).sequence, 1);
  cable.hold_next_reply();
  EXPECT_THROW(remote.exchange({.sequence = 2}), std::runtime_error);
  // RTU itself cannot tell: the late reply to 2 comes as if it were the one to 3. The echo tells.
  EXPECT_EQ(remote.exchange({.sequence = 3}).sequence, 2);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(remote.exchange({.sequence = 4}).sequence, 4);
}

TEST(ModbusDrive, RefusesALinkThatCannotBe) {
  EXPECT_THROW(ModbusDrive({.device = "/dev/no-such-line"}), UserError);
  EXPECT_THROW(ModbusDrive({.port = 1, .response_timeout_s = 0.5}), UserError);
  EXPECT_THROW(ModbusDrive({.response_timeout_s = -1}), UserError);
  SimulatedDrive drive;
  EXPECT_THROW(ModbusDriveServer(drive, {.host = "192.0.2.1"}, [] { return std::int64_t{0}; }), UserError);
}

}  // namespace
}  // namespace waverig::motion
