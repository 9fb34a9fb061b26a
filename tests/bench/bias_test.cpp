// Kim, section 4: bias against temperature, its hysteresis, and the master oscillator.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/in_memory_bench.h"

namespace waverig::rig::bench {
namespace {

using estimator::BiasReading;
using estimator::BiasResult;
using estimator::FrontEndChannel;

// The chamber ramps -10 … +50 degC and back at 0.1 degC/min; a count each 100 s. All channels at once.
struct RampRecord {
  std::array<std::vector<BiasReading>, kChannels> channels;
  std::vector<estimator::OscillatorReading> oscillator;
};

RampRecord ramp(InMemoryBench& bench, double reference_error) {
  RampRecord record;
  bench.set_temperature(20);   // the laboratory, as the chamber begins
  bench.set_temperature(-10);
  constexpr int kSteps = 360, kHold = 60;   // of 100 s: each way, and at either end, longer than the board's lag
  for (int i = 0; i < 2 * (kSteps + kHold); ++i) {
    const int up = std::clamp(i - kHold, 0, kSteps), down = std::clamp(i - 2 * kHold - kSteps, 0, kSteps);
    const double air_degC = -10 + (up - down) / 6.0;
    const UnitState before = bench.state;
    for (int k = 0; k < 10; ++k) {
      follow_temperature(bench.unit, bench.state, air_degC, 10);
      count(bench.unit, bench.state, {}, 1e6 * (1 + reference_error), 1000);
    }
    const double ratio = static_cast<double>(bench.state.clock - before.clock) / (kConverterClock_Hz * 100);
    const double T = 0.5 * (thermometer_degC(bench.unit, before) + thermometer_degC(bench.unit, bench.state));
    for (std::size_t c = 0; c < kChannels; ++c)
      record.channels[c].push_back(
          {T, estimator::count_rate_Hz(static_cast<double>(bench.state.channels[c].N - before.channels[c].N), 100, ratio),
           estimator::count_rate_Hz(static_cast<double>(bench.state.channels[c].P - before.channels[c].P), 100, ratio), 100});
    record.oscillator.push_back({T, static_cast<double>(bench.state.reference - before.reference), 1e6, 100});
  }
  return record;
}

FrontEndChannel by_design(const InMemoryBench& bench, int channel) {
  FrontEndChannel c;
  c.name = channel_name(channel);
  c.K_N0_C = c.K_P0_C = bench.unit.channels[static_cast<std::size_t>(channel)].K_N0_C;
  return c;
}

TEST(BiasLaw, StandsWithinTheSpecificationFromColdAndFromHotAndTheIntervalsCover) {
  int inside = 0, total = 0;
  double worst_gyro = 0, worst_accel = 0;
  constexpr int kUnits = 40;   // of ten channels
  for (int u = 0; u < kUnits; ++u) {
    InMemoryBench bench(static_cast<std::uint64_t>(500 + u));
    const RampRecord record = ramp(bench, 0);
    std::vector<BiasResult> found;
    std::vector<FrontEndChannel> channels;
    for (int c = 0; c < kChannels; ++c) {
      channels.push_back(by_design(bench, c));
      found.push_back(fit_bias(record.channels[static_cast<std::size_t>(c)], channels.back()));
      channels.back().bias_A = found.back().law;
      channels.back().bias_loop = found.back().half_loop;
    }
    RandomStream history(static_cast<std::uint64_t>(u), "thermal history");
    for (int visit = 0; visit < 12; ++visit) {
      // Anywhere in the span, from a cold or from a hot start.
      bench.set_temperature(history.uniform() < 0.5 ? -10 : 50);
      bench.set_temperature(history.uniform(-5, 45));
      const double T = thermometer_degC(bench.unit, bench.state);
      for (int c = 0; c < kChannels; ++c) {
        const ChannelState& truth = bench.state.channels[static_cast<std::size_t>(c)];
        const BiasResult& f = found[static_cast<std::size_t>(c)];
        const double error_A = f.law.at(T) - truth.bias_A;
        double& worst = is_gyro(c) ? worst_gyro : worst_accel;
        worst = std::max(worst, std::abs(error_A));
        inside += std::abs(error_A) <= channels[static_cast<std::size_t>(c)].bias_expanded_A(T);
        ++total;
      }
    }
  }
  const double coverage = 100.0 * inside / total;
  RecordProperty("worst_gyro_nA", std::to_string(1e9 * worst_gyro));
  RecordProperty("worst_accel_nA", std::to_string(1e9 * worst_accel));
  RecordProperty("coverage_percent", std::to_string(coverage));
  EXPECT_LT(worst_gyro, 24e-9);    // Kim, Table 1: 0.08 ppm of 299 mA
  EXPECT_LT(worst_accel, 72e-9);   // 2.97 ppm of 24.2 mA
  EXPECT_GE(coverage, 93);
  EXPECT_LE(coverage, 97);
}

TEST(BiasLaw, ReportsTheHysteresisThatIsThere) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    InMemoryBench bench(seed);
    ChannelTruth& t = bench.unit.channels[7];
    t.hysteresis = {{{10e-9, 3.0}, {15e-9, 8.0}}};
    t.bias_A = {200e-9, 0, 0, 0};   // no slope, so the dies' lag behind the thermometer widens nothing
    bench.state = settled_unit(bench.unit, -10, seed);
    const RampRecord record = ramp(bench, 0);
    const BiasResult found = fit_bias(record.channels[7], by_design(bench, 7));
    EXPECT_NEAR(found.hysteresis_A, 50e-9, 2e-9);   // up by -25, down by +25
  }
}

TEST(BiasLaw, NeedsBothRamps) {
  InMemoryBench bench(2);
  RampRecord record = ramp(bench, 0);
  record.channels[0].resize(360);
  EXPECT_ANY_THROW(fit_bias(record.channels[0], by_design(bench, 0)));
}

TEST(MasterOscillator, IsFoundWithinTheReferenceAndTheIntervalsCover) {
  int inside = 0, total = 0;
  for (int u = 0; u < 40; ++u) {
    InMemoryBench bench(static_cast<std::uint64_t>(900 + u));
    const GeneratorTruth generator = draw_generator(static_cast<std::uint64_t>(900 + u));
    const RampRecord record = ramp(bench, generator.error);
    const estimator::OscillatorResult found = estimator::fit_oscillator(record.oscillator);
    for (double T = -5; T <= 45; T += 10) {
      const double truth = cubic_at(bench.unit.master_error, T - bench.unit.thermometer_offset_degC);
      EXPECT_NEAR(found.law.at(T), truth, 6e-6);
      EXPECT_NEAR(found.law.at(T) - truth, -generator.error, 0.05e-6);   // all that is left is the reference's own
      inside += std::abs(found.law.at(T) - truth) <= 2 * found.law.sigma_at(T);
      ++total;
    }
  }
  EXPECT_GE(1.0 * inside / total, 0.85);   // forty independent references
}

TEST(TemperatureLaw, TheDataChooseTheOrder) {
  for (const int order : {0, 1, 2, 3}) {
    int right = 0;
    constexpr int kTrials = 200;
    for (int trial = 0; trial < kTrials; ++trial) {
      RandomStream random(static_cast<std::uint64_t>(trial), "order");
      std::vector<estimator::TemperaturePoint> points;
      for (double T = -10; T <= 50; T += 5) {
        const double x = (T - 20) / 30;
        points.push_back({T, 1 + (order > 0 ? x : 0) + (order > 1 ? x * x : 0) + (order > 2 ? 2 * x * x * x : 0) +
                                 random.gaussian(0.05), 0.05});
      }
      right += fit_temperature_law(points, {20, 3, true}).law.order() == order;
    }
    EXPECT_GE(right, 0.85 * kTrials) << order;   // 5 % a test, up to three tests
  }
}

TEST(TemperatureLaw, StatedSigmaIsTheScatterThatComes) {
  double sum_squares = 0, stated = 0;
  for (int trial = 0; trial < 500; ++trial) {
    RandomStream random(static_cast<std::uint64_t>(trial), "sigma");
    std::vector<estimator::TemperaturePoint> points;
    for (const double T : kTemperatures_degC) points.push_back({T, 3 + 0.2 * T + random.gaussian(0.3), 0.3});
    const auto fit = fit_temperature_law(points, {20, 1, true});
    sum_squares += std::pow(fit.law.at(42) - (3 + 0.2 * 42), 2);
    stated += std::pow(fit.law.sigma_at(42), 2) / (fit.dispersion * fit.dispersion);
  }
  EXPECT_NEAR(std::sqrt(sum_squares / stated), 1, 0.1);
}

}  // namespace
}  // namespace waverig::rig::bench
