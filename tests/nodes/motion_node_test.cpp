#include "rig/nodes/motion_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>
#include <waverig/alarm_t.hpp>
#include <waverig/axis_t.hpp>
#include <waverig/record_t.hpp>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "lcmtypes/channels.h"
#include "motion/simulated_drive.h"
#include "rig/nodes/run_watch.h"

namespace waverig::rig {
namespace {

constexpr std::int64_t kPeriod_us = 10000;
constexpr motion::ProfileSettings kProfile{
    .period_s = 4, .steady_s = 40, .ramp_periods = 1, .rest_before_s = 1, .rest_after_s = 1};

// A motion node, the simulated drive and all that they say, in virtual time.
class Laboratory {
 public:
  Laboratory() : node_(bus_, drive_, {}, motion::RotationProfile(kProfile), {.period_s = 4, .height_m = 1}) {
    bus_.subscribe<run_t>(channel::kRun, [this](const run_t& m) { phases.push_back(m); });
    bus_.subscribe<record_t>(channel::kRecord, [this](const record_t& m) { records.push_back(m.action); });
  }
  void run_until(double t_s) {
    while (1e-6 * static_cast<double>(utime_) < t_s) {
      utime_ += kPeriod_us;
      node_.cycle(utime_);
      drive_.advance(1e-6 * kPeriod_us);
      bus_.drain();
    }
  }
  double now_s() const { return 1e-6 * static_cast<double>(utime_); }
  MotionNode& node() { return node_; }
  motion::SimulatedDrive& drive() { return drive_; }
  Bus& bus() { return bus_; }
  Phase last_phase() const { return static_cast<Phase>(phases.back().phase); }

  std::vector<run_t> phases;
  std::vector<std::int32_t> records;

 private:
  Bus bus_;
  motion::SimulatedDrive drive_;
  MotionNode node_;
  std::int64_t utime_ = 0;
};

TEST(MotionNode, AnnouncesAHeldSpanAsHeldAndTheRestAsSteadyAgain) {
  Laboratory laboratory;
  laboratory.run_until(15);
  ASSERT_EQ(laboratory.last_phase(), Phase::kSteady);
  laboratory.node().hold();
  laboratory.run_until(25);
  ASSERT_EQ(laboratory.last_phase(), Phase::kHeld);
  EXPECT_NEAR(laboratory.drive().shaft().rate_radps, 0, 1e-3) << "it really stands";
  EXPECT_NEAR(1e-6 * static_cast<double>(laboratory.phases.back().utime), 15, 5)
      << "announced when it began, not when it stood";
  laboratory.node().resume();
  laboratory.run_until(40);
  EXPECT_EQ(laboratory.last_phase(), Phase::kSteady);
  EXPECT_NEAR(std::abs(laboratory.drive().shaft().rate_radps), 2 * M_PI / 4, 0.01);
  laboratory.run_until(120);
  EXPECT_TRUE(laboratory.node().finished());
  EXPECT_EQ(laboratory.node().alarm(), "");
  EXPECT_EQ(std::count_if(laboratory.phases.begin(), laboratory.phases.end(),
                          [](const run_t& m) { return m.phase == static_cast<std::int32_t>(Phase::kHeld); }),
            1);
}

TEST(MotionNode, ToldToStopEndsTheRecordAndLeavesTheDriveOff) {
  Laboratory laboratory;
  const RunWatch watch(laboratory.bus());
  laboratory.run_until(15);
  ASSERT_FALSE(laboratory.node().finished());
  EXPECT_FALSE(laboratory.node().at_rest());
  laboratory.node().stop();
  laboratory.run_until(25);
  EXPECT_TRUE(laboratory.node().finished());
  EXPECT_TRUE(laboratory.node().at_rest());
  EXPECT_EQ(laboratory.last_phase(), Phase::kStopped);
  EXPECT_EQ(laboratory.records, (std::vector<std::int32_t>{1, 2}));
  EXPECT_TRUE(watch.ended());
  EXPECT_NE(watch.stopped().find("as told"), std::string::npos) << watch.stopped();
  EXPECT_NE(laboratory.drive().state(), motion::DriveState::kOperationEnabled);
  EXPECT_EQ(laboratory.drive().shaft().rate_radps, 0);
}

TEST(MotionNode, ToldToStopBeforeTheRunBeginsAnnouncesNothing) {
  Laboratory laboratory;
  laboratory.node().stop();
  laboratory.run_until(15);
  EXPECT_TRUE(laboratory.node().finished());
  EXPECT_TRUE(laboratory.node().at_rest());
  EXPECT_TRUE(laboratory.records.empty());
  EXPECT_TRUE(laboratory.phases.empty());
}

TEST(MotionNode, AWholeRunIsNotCutShort) {
  Laboratory laboratory;
  const RunWatch watch(laboratory.bus());
  laboratory.run_until(70);
  EXPECT_TRUE(watch.ended());
  EXPECT_EQ(watch.stopped(), "");
  EXPECT_TRUE(laboratory.node().at_rest());
}

// What a real rig has of truth: against the shaft that the encoder sits on.
TEST(MotionNode, TellsByItsEncoderWhatTheArmDid) {
  Laboratory laboratory;
  std::vector<truth_t> truth;
  std::vector<double> true_angle_rad;
  laboratory.bus().subscribe<truth_t>(channel::kTruth, [&](const truth_t& m) {
    truth.push_back(m);
    true_angle_rad.push_back(laboratory.drive().shaft().angle_rad);
  });
  laboratory.run_until(0.5);
  EXPECT_TRUE(truth.empty());
  const double radius_m = 0.5, azimuth_rad = 0.3;
  laboratory.node().tell_truth({radius_m, azimuth_rad});
  laboratory.run_until(45);
  ASSERT_GT(truth.size(), 4400U);
  double highest_m = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    EXPECT_EQ(truth[i].utime - truth[i - 1].utime, kPeriod_us);
    EXPECT_EQ(truth[i].seq, truth[i - 1].seq + 1);
    // One control period of a turn of 4 s is 0.9 degrees.
    EXPECT_NEAR(truth[i].heave_m, radius_m * std::sin(true_angle_rad[i]), radius_m * 0.016);
    EXPECT_NEAR(std::hypot(truth[i].north_m, truth[i].east_m), radius_m * std::abs(std::cos(true_angle_rad[i])),
                radius_m * 0.016);
    EXPECT_NEAR(truth[i].heave_rate_mps,
                (truth[i].heave_m - truth[i - 1].heave_m) / (1e-6 * static_cast<double>(kPeriod_us)), 0.02);
    highest_m = std::max(highest_m, truth[i].heave_m);
  }
  EXPECT_NEAR(highest_m, radius_m, 1e-4);
}

TEST(MotionNode, TellsTheBusOfAnAlarmAndOfItsReason) {
  Laboratory laboratory;
  const RunWatch watch(laboratory.bus());
  laboratory.run_until(15);
  laboratory.drive().faults.jam_Nm = 500;
  laboratory.run_until(30);
  EXPECT_TRUE(watch.ended());
  EXPECT_NE(watch.stopped().find("alarm"), std::string::npos) << watch.stopped();
  EXPECT_TRUE(laboratory.node().at_rest());
}

// A drive that has much to complain of.
struct Talkative final : motion::Drive {
  motion::DriveFeedback exchange(const motion::DriveCommand&) override {
    throw std::runtime_error(std::string(1000, 'x'));
  }
};

TEST(MotionNode, TellsOfAnAlarmAsMuchAsItsMessageHolds) {
  Bus bus;
  const RunWatch watch(bus);
  std::string text;
  bus.subscribe<alarm_t>(channel::kAlarm,
                         [&](const alarm_t& m) { text.assign(std::begin(m.text), std::end(m.text)); });
  Talkative drive;
  MotionNode node(bus, drive, {}, motion::RotationProfile(kProfile), {});
  for (std::int64_t utime = 0; utime < 50 * kPeriod_us; utime += kPeriod_us) node.cycle(utime);
  bus.drain();
  EXPECT_TRUE(node.finished());
  EXPECT_EQ(text, node.alarm().substr(0, sizeof alarm_t{}.text));
  EXPECT_EQ(watch.stopped(), text);
}

}  // namespace
}  // namespace waverig::rig
