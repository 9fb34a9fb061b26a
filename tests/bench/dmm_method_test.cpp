// The shipped sequence of the DMM method, over the simulated instruments, against what the simulated converter is.
#include <gtest/gtest.h>

#include <cmath>

#include "lcmtypes/error.h"
#include "rig/bench/bench.h"
#include "tests/bench/short_sequence.h"

namespace waverig::rig::bench {
namespace {

constexpr const char* kName = "scale_factor_dmm.toml";

// Two channels, and a fifth of the time.
ShortSequence::Changes two_channels() {
  return {{"duration = \"27.6 h\" ", "# "},
          {"duration = \"100 s\"", "duration = \"20 s\""},
          {"count = 5", "count = 2"},
          {"gyros = [\"gyro_1\", \"gyro_2\", \"gyro_3\", \"gyro_4\", \"gyro_5\", \"gyro_6\"]", "gyros = [\"gyro_2\"]"},
          {"accels = [\"accel_1\", \"accel_2\", \"accel_3\", \"accel_4\"]", "accels = [\"accel_1\"]"}};
}

constexpr std::uint64_t kSeed = 3;

BenchOptions options_for(const std::filesystem::path& out) {
  BenchOptions options;
  options.out = out;
  options.simulate = true;
  options.simulation.world.seed = options.simulation.world.noise_seed = kSeed;
  options.version = "test";
  return options;
}

TEST(DmmSequence, FindsTheSimulatedConverterWithinItsStatedUncertainty) {
  const ShortSequence files(kName, two_channels());
  const Sequence sequence = load_sequence(files.file());
  ASSERT_EQ(run_bench(sequence, options_for(files.out())).outcome, "done");
  const Store store = Store::open(store_file(files.out()));

  int readings = 0;   // in the unit's place, at both polarities
  for (const StepRow& row : store.steps()) {
    const PlannedStep& step = sequence.plan[static_cast<std::size_t>(row.index)];
    if (step.verb != Verb::kRead || step.instrument != "dmm") continue;
    ++readings;
    EXPECT_EQ(*row.value > 0, step.tags.at("setting").starts_with("+"));
  }
  EXPECT_EQ(readings, 5 * 2 * 12 * 2);                 // temperatures, channels, settings, readings of each
  for (const RecordingRow& row : store.recordings())   // the unit counts the level, not the meter's open path
    EXPECT_GT(row.channels[0].N + row.channels[0].P, 19'000) << row.tags.at("setting");

  const Analysis analysis = analyse(sequence, store);
  const UnitTruth truth = draw_unit(UnitSpread{}, kSeed);
  int inside = 0, total = 0;
  for (const auto& [name, index] : {std::pair{"gyro_2", 1}, {"accel_1", 6}}) {
    const ChannelTruth& t = truth.channels[static_cast<std::size_t>(index)];
    const estimator::FrontEndChannel& found = analysis.calibration.channel(name);
    for (const double T : {-10.0, 5.0, 20.0, 35.0, 50.0})
      for (const auto& [law, cubic] : {std::pair{found.dsf_N, t.dsf_N}, {found.dsf_P, t.dsf_P}}) {
        const double shown_degC = T + truth.thermometer_offset_degC, sigma = law.sigma_at(shown_degC);
        const double error = law.at(shown_degC) - cubic_at(cubic, T);
        inside += std::abs(error) <= 2 * sigma;
        ++total;
        EXPECT_LT(std::abs(error), 3 * sigma) << name << " at " << T << " degC";
        EXPECT_LT(sigma, 25e-6) << name;   // the DMM's 12 ppm at 95 %, and what the 30 uA level adds
      }
  }
  EXPECT_GE(inside, 18) << "of " << total;
}

TEST(DmmSequence, AMeterThatIsNotConnectedEndsTheRun) {
  const ShortSequence files(kName, two_channels());
  BenchOptions options = options_for(files.out());
  options.simulation.faults = {{"dmm", FaultType::kWrong, 0, 1e12, 0.0}};
  const BenchResult result = run_bench(load_sequence(files.file()), options);
  EXPECT_FALSE(result.complete);
  EXPECT_NE(result.outcome.find("dmm: out of range"), std::string::npos) << result.outcome;
}

TEST(DmmSequence, ALevelWithoutItsReadingIsRefusedByName) {
  ShortSequence::Changes changes = two_channels();
  changes.emplace_back("[\"-10 degC\", \"5 degC\", \"20 degC\", \"35 degC\", \"50 degC\"]", "[\"20 degC\"]");
  changes.emplace_back("[[blocks.one_setting]]\nfor = \"reading\"\ncount = 2\ndo = \"one_reading\"\n", "");
  const ShortSequence files(kName, changes);
  const Sequence sequence = load_sequence(files.file());
  ASSERT_EQ(run_bench(sequence, options_for(files.out())).outcome, "done");
  try {
    analyse(sequence, Store::open(store_file(files.out())));
    FAIL() << "a calibration without a reading";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("gyro_2 at 20 degC: level 3e-05 A: expected both polarities"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace waverig::rig::bench
