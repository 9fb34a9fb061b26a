// What the simulated rig says of the truth.
#include "rig/nodes/simulated_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>
#include <waverig/record_t.hpp>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "lcmtypes/channels.h"
#include "motion/axis_controller.h"
#include "rig/nodes/simulated_sea.h"

namespace waverig::rig {
namespace {

constexpr std::int64_t kBegin = 1'700'000'000'000'000;

// The arm turns once in four seconds, its plane to the north-east.
std::vector<truth_t> truths_of(bool in_real_time) {
  Bus bus;
  std::vector<truth_t> truths;
  bus.subscribe<truth_t>(channel::kTruth, [&](const truth_t& m) { truths.push_back(m); });
  SimulatedRigSettings settings;
  settings.arm.azimuth_rad = 0.25 * std::numbers::pi;
  settings.arm.lever_arm_G_m.setZero();
  SimulatedRig rig(bus, settings, {}, kBegin);
  motion::AxisController controller(rig.drive(), {});
  controller.enable();
  for (std::int64_t utime = kBegin; utime < kBegin + 30'000'000; utime += 10'000) {
    if (utime == kBegin + 1'000'000)
      controller.start(motion::RotationProfile({.period_s = 4, .ramp_periods = 1, .rest_before_s = 0}),
                       utime);
    controller.cycle(utime);
    // In real time it is looked at whenever: every 2.5 ms.
    if (!in_real_time) rig.advance(0.01);
    for (int part = 1; in_real_time && part <= 4; ++part) rig.advance_to(utime + 2500 * part);
    bus.drain();
  }
  return truths;
}

TEST(SimulatedRig, TellsEachTruthByItsNumberAtItsIntervalAndAsTheArmMoved) {
  for (const bool in_real_time : {false, true}) {
    const std::vector<truth_t> truths = truths_of(in_real_time);
    ASSERT_NEAR(static_cast<double>(truths.size()), 3000, 1);
    double fastest = 0;
    for (std::size_t i = 1; i + 1 < truths.size(); ++i) {
      const truth_t &a = truths[i - 1], &m = truths[i], &b = truths[i + 1];
      ASSERT_EQ(m.seq, static_cast<std::int64_t>(i));
      ASSERT_EQ(m.utime - a.utime, 10'000);
      ASSERT_NEAR(m.heave_m, 0.5 * std::sin(m.arm_angle_rad), 1e-12);
      ASSERT_NEAR(m.north_m, 0.5 * std::cos(m.arm_angle_rad) * std::numbers::sqrt2 / 2, 1e-12);
      ASSERT_NEAR(m.east_m, m.north_m, 1e-12);
      ASSERT_NEAR((b.heave_m - a.heave_m) / 0.02, m.heave_rate_mps, 1e-3);
      fastest = std::max(fastest, std::abs(m.heave_rate_mps));
    }
    EXPECT_NEAR(fastest, 0.5 * 2 * std::numbers::pi / 4, 1e-3);
  }
}

TEST(SimulatedSea, AnnouncesItsRecordFromBeginToEndAndNumbersItsTruths) {
  Bus bus;
  std::vector<std::pair<std::int64_t, std::int32_t>> records, phases;
  std::vector<truth_t> truths;
  bus.subscribe<record_t>(channel::kRecord,
                          [&](const record_t& m) { records.emplace_back(m.utime, m.action); });
  bus.subscribe<run_t>(channel::kRun, [&](const run_t& m) { phases.emplace_back(m.utime, m.phase); });
  bus.subscribe<truth_t>(channel::kTruth, [&](const truth_t& m) { truths.push_back(m); });
  SimulatedSeaSettings settings;
  settings.duration_s = 10;
  SimulatedSea sea(bus, settings, {}, kBegin, {});
  while (!sea.finished()) sea.advance(0.1);
  sea.advance(0.1);
  bus.drain();
  const auto of = [](auto x) { return static_cast<std::int32_t>(x); };
  using Said = std::vector<std::pair<std::int64_t, std::int32_t>>;
  EXPECT_EQ(records,
            (Said{{kBegin, of(RecordAction::kBegin)}, {kBegin + 10'000'000, of(RecordAction::kEnd)}}));
  EXPECT_EQ(phases, (Said{{kBegin, of(Phase::kSteady)}, {kBegin + 10'000'000, of(Phase::kRest)}}));
  ASSERT_EQ(truths.size(), 102U);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    EXPECT_EQ(truths[i].seq, static_cast<std::int64_t>(i));
    EXPECT_EQ(truths[i].utime, kBegin + 100'000 * static_cast<std::int64_t>(i));
  }
}

}  // namespace
}  // namespace waverig::rig
