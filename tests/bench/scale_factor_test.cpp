// Kim, section 3.1: scale factors by calibrator and by DMM.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/in_memory_bench.h"

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndChannel;
using estimator::FrontEndReading;
using estimator::RowWeighting;
using estimator::ScaleFactors;
using estimator::ScaleFactorsAtTemperature;

double relative(double value, double truth) { return value / truth - 1; }

FrontEndChannel calibrate(InMemoryBench& bench, int channel, RowWeighting weighting = RowWeighting::kLevel) {
  FrontEndChannel result;
  result.K_N0_C = result.K_P0_C = bench.unit.channels[static_cast<std::size_t>(channel)].K_N0_C;
  std::vector<ScaleFactorsAtTemperature> points;
  for (const double T : kTemperatures_degC) {
    bench.set_temperature(T);
    points.push_back({T, estimator::scale_factors_by_calibrator(bench.settings(channel), knowledge_of(channel), weighting)});
  }
  estimator::fit_scale_factor_laws(points, result);
  return result;
}

// The converter without calibrator errors, noise and droop: only the counts' resolution is left.
InMemoryBench clean_bench(std::uint64_t seed) {
  UnitSpread spread;
  for (ChannelSpread* s : {&spread.gyro, &spread.accel}) s->noise_A_sqrt_s = s->wander_A = s->droop = 0;
  InMemoryBench bench(seed, spread);
  bench.calibrator.gain = {};
  bench.calibrator.floor_drift = 0;
  return bench;
}

TEST(ScaleFactorByCalibrator, RecoversBothScaleFactorsFromCountsOf100Seconds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    InMemoryBench bench = clean_bench(seed);
    for (const int channel : {0, 9}) {
      const ScaleFactors f = estimator::scale_factors_by_calibrator(bench.settings(channel), knowledge_of(channel));
      const ChannelState& truth = bench.state.channels[static_cast<std::size_t>(channel)];
      // One pulse of 30 nC in 100 s is 10 ppm of the smallest gyroscope level, and it is one row of six.
      const double bound = is_gyro(channel) ? 6e-6 : 1e-6;
      EXPECT_NEAR(relative(f.K_N_C, truth.quantum_N_C), 0, bound);
      EXPECT_NEAR(relative(f.K_P_C, truth.quantum_P_C), 0, bound);
    }
  }
}

TEST(ScaleFactorByCalibrator, EquationSevenAsPrintedDoesNotFollow) {
  // Read with +i_calbias at zero, the calibrator's bias would not leave the negative rows: taking the zero reading of
  // the positive polarity for both, as the print implies, must show an error of two biases.
  InMemoryBench bench = clean_bench(3);
  bench.calibrator.bias_A.fill(3e-9);
  std::vector<FrontEndReading> readings = bench.settings(0), printed = readings;
  for (FrontEndReading& r : printed)
    if (r.level_A == 0 && r.polarity < 0)
      for (const FrontEndReading& plus : readings)
        if (plus.level_A == 0 && plus.polarity > 0 && plus.range_A == r.range_A)
          r.rate_N_Hz = plus.rate_N_Hz, r.rate_P_Hz = plus.rate_P_Hz;
  const double truth = bench.state.channels[0].quantum_P_C;
  const auto error = [&](const std::vector<FrontEndReading>& rows) {
    return std::abs(relative(estimator::scale_factors_by_calibrator(rows, knowledge_of(0)).K_P_C, truth));
  };
  EXPECT_LT(error(readings), 6e-6);
  EXPECT_GT(error(printed), 20e-6);
}

TEST(ScaleFactorByCalibrator, ZeroReadingsMustBelongToTheRange) {
  InMemoryBench bench = clean_bench(4);
  std::vector<FrontEndReading> readings = bench.settings(0);
  std::erase_if(readings, [](const FrontEndReading& r) { return r.level_A == 0 && r.range_A > 1e-3; });
  EXPECT_ANY_THROW(estimator::scale_factors_by_calibrator(readings, knowledge_of(0)));
}

TEST(ScaleFactorByCalibrator, LevelWeightingGuardsTheSmallestLevel) {
  // A converter whose quanta droop by 100 ppm at full rate and a calibrator whose ranges differ by their 20 ppm.
  double weighted = 0, unweighted = 0;
  constexpr int kUnits = 60;
  for (int i = 0; i < kUnits; ++i) {
    InMemoryBench bench(static_cast<std::uint64_t>(100 + i));
    for (ChannelTruth& t : bench.unit.channels) t.droop = 100e-6;
    const std::vector<FrontEndReading> readings = bench.settings(2);
    const double truth = bench.state.channels[2].quantum_N_C;   // at the smallest level the droop is nothing
    const auto square = [&](RowWeighting w) {
      return std::pow(relative(estimator::scale_factors_by_calibrator(readings, knowledge_of(2), w).K_N_C, truth), 2);
    };
    weighted += square(RowWeighting::kLevel) / kUnits;
    unweighted += square(RowWeighting::kNone) / kUnits;
  }
  RecordProperty("weighted_ppm", std::to_string(1e6 * std::sqrt(weighted)));
  RecordProperty("unweighted_ppm", std::to_string(1e6 * std::sqrt(unweighted)));
  EXPECT_LT(std::sqrt(weighted), 0.4 * std::sqrt(unweighted));
}

TEST(ScaleFactorByDmm, HalfDifferencesAloneCannotTellTheTwoScaleFactorsApart) {
  InMemoryBench bench = clean_bench(5);
  const std::vector<FrontEndReading> readings = bench.settings(0);
  std::vector<Eigen::Vector2d> rows;   // eq. (14), divided by the level
  for (const FrontEndReading& p : readings)
    for (const FrontEndReading& m : readings)
      if (p.level_A > 0 && m.level_A == p.level_A && p.polarity > 0 && m.polarity < 0)
        rows.emplace_back((p.rate_N_Hz - m.rate_N_Hz) / p.level_A, -(p.rate_P_Hz - m.rate_P_Hz) / p.level_A);
  for (const Eigen::Vector2d& row : rows)
    EXPECT_LT(std::abs(row[0] * rows[0][1] - row[1] * rows[0][0]), 1e-2 * row.norm() * rows[0].norm());
}

TEST(ScaleFactorByDmm, RecoversBothScaleFactorsWithinTheDmm) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    InMemoryBench bench(seed);
    const ScaleFactors f = estimator::scale_factors_by_dmm(bench.settings(8), knowledge_of(8));
    const ChannelState& truth = bench.state.channels[8];
    worst = std::max({worst, std::abs(relative(f.K_N_C, truth.quantum_N_C)), std::abs(relative(f.K_P_C, truth.quantum_P_C))});
  }
  EXPECT_LT(worst, 25e-6);
}

TEST(ScaleFactorByDmm, IsBlindToTheCalibratorsOwnError) {
  InMemoryBench bench = clean_bench(6);
  bench.dmm.gain = {};
  bench.calibrator.gain.fill(500e-6);
  const ScaleFactors f = estimator::scale_factors_by_dmm(bench.settings(9), knowledge_of(9));
  EXPECT_NEAR(relative(f.K_N_C, bench.state.channels[9].quantum_N_C), 0, 5e-6);
}

TEST(ScaleFactorByDmm, TheStatedIntervalsCoverTheTruthOfTwoHundredUnits) {
  int inside = 0, total = 0;
  double squares = 0;
  for (int i = 0; i < 200; ++i) {
    InMemoryBench bench(static_cast<std::uint64_t>(4000 + i));
    const int channel = i % kChannels;
    const ScaleFactors f = estimator::scale_factors_by_dmm(bench.settings(channel), knowledge_of(channel));
    const ChannelState& truth = bench.state.channels[static_cast<std::size_t>(channel)];
    const Eigen::Matrix2d covariance = f.covariance_random + f.covariance_common;
    for (const auto& [value, quantum, which] : {std::tuple{f.K_N_C, truth.quantum_N_C, 0}, {f.K_P_C, truth.quantum_P_C, 1}}) {
      const double score = relative(value, quantum) / std::sqrt(covariance(which, which));
      inside += std::abs(score) <= 2;
      squares += score * score;
      ++total;
    }
  }
  const double coverage = 100.0 * inside / total;
  RecordProperty("coverage_percent", std::to_string(coverage));
  RecordProperty("closure", std::to_string(std::sqrt(squares / total)));
  EXPECT_GE(coverage, 92);
  EXPECT_LE(coverage, 98);
  EXPECT_NEAR(std::sqrt(squares / total), 1, 0.12);
}

TEST(ScaleFactorLaws, HoldOverTemperatureForTwoHundredUnitsAndTheIntervalsCover) {
  int inside = 0, total = 0;
  double worst = 0, sum_squares = 0, stated = 0;
  constexpr int kUnits = 200;
  for (int i = 0; i < kUnits; ++i) {
    InMemoryBench bench(static_cast<std::uint64_t>(2000 + i));
    const int channel = i % kChannels;
    const FrontEndChannel found = calibrate(bench, channel);
    RandomStream where(static_cast<std::uint64_t>(i), "where");
    for (double T = -10; T <= 50; T += 5) {
      bench.set_temperature(T);
      const ChannelState& truth = bench.state.channels[static_cast<std::size_t>(channel)];
      worst = std::max({worst, std::abs(relative(found.K_N_C(T), truth.quantum_N_C)),
                        std::abs(relative(found.K_P_C(T), truth.quantum_P_C))});
    }
    const double T = where.uniform(-10, 50);
    bench.set_temperature(T);
    const ChannelState& truth = bench.state.channels[static_cast<std::size_t>(channel)];
    for (const auto& [value, law, quantum] :
         {std::tuple{found.K_N_C(T), found.dsf_N, truth.quantum_N_C}, std::tuple{found.K_P_C(T), found.dsf_P, truth.quantum_P_C}}) {
      const double error = relative(value, quantum), sigma = law.sigma_at(T);
      inside += std::abs(error) <= 2 * sigma;
      ++total;
      sum_squares += error * error;
      stated += sigma * sigma;
    }
  }
  const double coverage = 100.0 * inside / total;
  RecordProperty("worst_ppm", std::to_string(1e6 * worst));
  RecordProperty("coverage_percent", std::to_string(coverage));
  RecordProperty("closure", std::to_string(std::sqrt(sum_squares / stated)));
  EXPECT_LT(worst, 25e-6);
  EXPECT_GE(coverage, 93);
  EXPECT_LE(coverage, 97);
  EXPECT_NEAR(std::sqrt(sum_squares / stated), 1, 0.1);   // observed over predicted scatter
}

TEST(ScaleFactorLaws, BudgetIsDominatedByTheCalibrator) {
  InMemoryBench bench(7);
  const FrontEndChannel found = calibrate(bench, 0);
  double calibrator = 0;
  for (const estimator::BudgetTerm& t : found.dsf_N_budget)
    if (t.name == "calibrator") calibrator = t.sigma;
  EXPECT_GT(calibrator, 0.8 * combined_sigma(found.dsf_N_budget));
  EXPECT_NEAR(combined_sigma(found.dsf_N_budget), found.dsf_N.sigma_at(20), 0.05 * found.dsf_N.sigma_at(20));
}

}  // namespace
}  // namespace waverig::rig::bench
