#include "rig/nodes/evaluator_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <waverig/heave_t.hpp>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>
#include <waverig/wave_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/flags.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {
namespace {

constexpr double kPeriod_s = 5, kHeight_m = 1;

void begin(Bus& bus, Phase phase, std::int64_t utime) {
  run_t m{};
  m.utime = utime;
  m.phase = static_cast<std::int32_t>(phase);
  m.period_s = kPeriod_s;
  m.height_m = kHeight_m;
  bus.publish(channel::kRun, m);
}

// A minute of truth, and of a method that answers with a gain of its own.
void run_minute(Bus& bus, const std::string& method, double gain, std::int64_t lost_truth) {
  begin(bus, Phase::kSteady, 0);
  for (std::int64_t i = 0; i <= 6000; ++i) {
    const double angle = 2 * M_PI / kPeriod_s * 0.01 * static_cast<double>(i);
    truth_t truth{};
    truth.utime = 10000 * i;
    truth.seq = i;
    truth.heave_m = kHeight_m / 2 * std::sin(angle);
    truth.heave_rate_mps = kHeight_m / 2 * 2 * M_PI / kPeriod_s * std::cos(angle);
    if (i != lost_truth) bus.publish(channel::kTruth, truth);
    heave_t heave{};
    heave.utime = truth.utime;
    heave.seq = i;
    heave.heave_m = gain * truth.heave_m;
    heave.heave_sigma_m = 0.01;
    bus.publish(channel::of_method(channel::kHeavePrefix, method), heave);
    bus.drain();
  }
  begin(bus, Phase::kRampOut, 60000000);
  bus.drain();
}

TEST(EvaluatorNode, JudgesAMethodThatNobodyToldItOf) {
  Bus bus;
  EvaluatorNode node(bus, "run", {});
  run_minute(bus, "someone.elses-1", 1.1, -1);
  const auto results = node.finish();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].method, "someone.elses-1");
  EXPECT_NEAR(results[0].heave_gain, 1.1, 1e-3);
  EXPECT_GE(results[0].statistics.waves, 10);
  EXPECT_NEAR(results[0].statistics.mean_height_m, 1.1 * kHeight_m, 1e-3);
}

TEST(EvaluatorNode, KeepsNamesOutThatWouldSpoilATable) {
  Bus bus;
  EvaluatorNode node(bus, "run", {});
  run_minute(bus, "a,b", 1, -1);
  run_minute(bus, "../etc", 1, -1);
  EXPECT_TRUE(node.finish().empty());
}

TEST(EvaluatorNode, CountsTheTruthThatWasLost) {
  Bus bus;
  EvaluatorNode node(bus, "run", {});
  run_minute(bus, "m", 1, 3000);
  EXPECT_EQ(node.truths_missing(), 1);
}

TEST(EvaluatorNode, FlagsAMethodOfWhoseWavesSomeWereLost) {
  for (const std::int64_t lost : {-1, 5}) {
    Bus bus;
    EvaluatorNode node(bus, "run", {});
    run_minute(bus, "m", 1, -1);
    for (std::int64_t i = 0; i < 10; ++i) {
      wave_t wave{};
      wave.utime = 1000000 + static_cast<std::int64_t>(1e6 * kPeriod_s) * i;
      wave.seq = i;
      wave.period_s = kPeriod_s;
      wave.height_m = kHeight_m;
      if (i != lost) bus.publish(channel::of_method(channel::kWavePrefix, "m"), wave);
    }
    bus.drain();
    const auto results = node.finish();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ((results[0].statistics.flags & flag::kGap) != 0, lost >= 0);
  }
}

}  // namespace
}  // namespace waverig::rig
