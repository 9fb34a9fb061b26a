#include "estimator/heave/spectral.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lcmtypes/flags.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::Spectral;

estimator::SeaState run_spectral(const std::vector<estimator::ImuSample>& samples,
                                 const estimator::MethodSettings& settings = {}) {
  Spectral method{settings};
  const Collector out = run(method, samples);
  EXPECT_EQ(out.seas.size(), 1u);
  return out.seas.at(0);
}

struct OwnTruth {
  double hm0_m, tm02_s;
};

OwnTruth own_truth(const SeaRecord& record) {
  double z = 0, zz = 0, v = 0, vv = 0;
  const auto n = static_cast<double>(record.heave_m.size());
  for (std::size_t i = 0; i < record.heave_m.size(); ++i) {
    z += record.heave_m[i] / n;
    zz += square(record.heave_m[i]) / n;
    v += record.heave_rate_mps[i] / n;
    vv += square(record.heave_rate_mps[i]) / n;
  }
  const double m0 = zz - z * z, m2 = vv - v * v;
  return {4 * std::sqrt(m0), 2 * kPi * std::sqrt(m0 / m2)};
}

TEST(Spectral, MeetsTheRecordsOwnHm0AndTm02WithinHalfAPercent) {
  for (const auto& [tp, hm0] : {std::pair{3.0, 0.5}, {6.0, 0.5}, {8.0, 1.5}, {12.0, 0.5}, {12.0, 4.0}})
    for (const std::uint64_t seed : {1, 2}) {
      const SeaRecord record = sea_record({.tp_s = tp, .hm0_m = hm0}, seed);
      const OwnTruth truth = own_truth(record);
      const estimator::SeaState sea = run_spectral(record.samples);
      EXPECT_NEAR(sea.hm0_m / truth.hm0_m, 1, 0.005) << "Tp " << tp << " s, Hm0 " << hm0 << " m, seed " << seed;
      EXPECT_NEAR(sea.tm02_s / truth.tm02_s, 1, 0.005) << "Tp " << tp << " s, Hm0 " << hm0 << " m, seed " << seed;
      EXPECT_NEAR(sea.tp_s / tp, 1, 0.12);
      EXPECT_GT(sea.tm_10_s, sea.tm01_s);
      EXPECT_GT(sea.tm01_s, sea.tm02_s);
      EXPECT_EQ(sea.flags, 0);
    }
}

TEST(Spectral, StatesAnHm0SigmaThatHolds) {
  double squared = 0;
  constexpr int kSeas = 8;
  for (std::uint64_t seed = 1; seed <= kSeas; ++seed) {
    const SeaRecord record = sea_record({.tp_s = 10, .hm0_m = 0.5, .duration_s = 600}, seed);
    const estimator::SeaState sea = run_spectral(record.samples);
    squared += square((sea.hm0_m - own_truth(record).hm0_m) / sea.hm0_sigma_m);
  }
  EXPECT_LT(squared / kSeas, 2.5);
  EXPECT_GT(squared / kSeas, 0.05);
}

// Of a sensor whose scale is known within 1 %, the Hm0 of every record is: a longer one lessens the rest alone.
TEST(Spectral, TellsWhichPartOfItsSigmaIsTheSensors) {
  estimator::MethodSettings settings;
  settings.sensor.accel_scale_sigma = 0.01;
  double rest_m = 1;
  for (const double duration_s : {600.0, 2400.0}) {
    const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5, .duration_s = duration_s}, 3);
    const estimator::SeaState sea = run_spectral(record.samples, settings);
    EXPECT_NEAR(sea.hm0_systematic_sigma_m / sea.hm0_m, 0.01, 5e-4) << duration_s;
    const double now_m = std::sqrt(square(sea.hm0_sigma_m) - square(sea.hm0_systematic_sigma_m));
    EXPECT_LT(now_m, 0.6 * rest_m) << duration_s;
    rest_m = now_m;
  }
}

TEST(Spectral, CountsTheWavesOfTheSmoothedHeave) {
  const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5}, 3);
  const estimator::SeaState sea = run_spectral(record.samples);
  EXPECT_GT(sea.hmax_m, sea.h110_m);
  EXPECT_GT(sea.h110_m, sea.h13_m);
  EXPECT_NEAR(sea.h13_m / sea.hm0_m, 0.95, 0.05);   // Rayleigh's is 1.0; broad spectra less
}

TEST(Spectral, OfARegularWaveGivesItsHeightAndPeriod) {
  SyntheticWaves waves;
  waves.period_s = 6;
  waves.height_m = 1;
  waves.duration_s = 600;
  const SyntheticRecord record = synthesize(waves, SensorErrors{}, 1);
  const estimator::SeaState sea = run_spectral(record.samples);
  EXPECT_NEAR(sea.hm0_m, std::sqrt(2.0), 0.01);   // 4 A / sqrt(2)
  EXPECT_NEAR(sea.tp_s, 6, 0.03);
  EXPECT_NEAR(sea.tm02_s, 6, 0.05);
  EXPECT_NEAR(sea.hmax_m, 1, 0.01);
}

// A minute or two hold no several blocks that resolve the waves: nothing may be lost for that.
TEST(Spectral, OfAShortRecordGivesItsOwnHm0AndTm02) {
  for (const double duration_s : {60.0, 120.0, 300.0})
    for (const auto& [tp, hm0] : {std::pair{3.0, 0.3}, {4.0, 0.5}, {6.0, 1.0}, {9.0, 2.0}, {12.0, 3.0}})
      for (const std::uint64_t seed : {1, 2}) {
        const SeaRecord record = sea_record({.tp_s = tp, .hm0_m = hm0, .duration_s = duration_s}, seed);
        const OwnTruth truth = own_truth(record);
        const estimator::SeaState sea = run_spectral(record.samples);
        const std::string what = fmt::format("{} s of Tp {} s, seed {}", duration_s, tp, seed);
        EXPECT_NEAR(sea.hm0_m / truth.hm0_m, 1, 0.015) << what;
        EXPECT_LT(std::abs(sea.hm0_m - truth.hm0_m), 3 * sea.hm0_sigma_m) << what;
        EXPECT_NEAR(sea.tm02_s / truth.tm02_s, 1, 0.015) << what;
        EXPECT_GT(sea.tm_10_s, sea.tm01_s) << what;
        EXPECT_GT(sea.tm01_s, sea.tm02_s) << what;
        EXPECT_EQ((sea.flags & flag::kTooFewWaves) != 0, duration_s < 20 * truth.tm02_s) << what;
      }
}

TEST(Spectral, OfAMinuteOfASwellGivesItsHeightAndPeriod) {
  for (const double period_s : {6.0, 12.0, 14.0}) {
    SyntheticWaves waves;
    waves.period_s = period_s;
    waves.height_m = 1;
    waves.duration_s = 60;
    const estimator::SeaState sea = run_spectral(synthesize(waves, SensorErrors{}, 1).samples);
    EXPECT_NEAR(sea.hm0_m, std::sqrt(2.0), 0.02) << period_s << " s";
    EXPECT_NEAR(sea.tp_s / period_s, 1, 0.02) << period_s << " s";
    EXPECT_NEAR(sea.tm02_s / period_s, 1, 0.03) << period_s << " s";
  }
}

TEST(Spectral, AGapIsNoTimeThatWasSeen) {
  SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 600}, 5);
  const estimator::SeaState whole = run_spectral(record.samples);
  for (std::size_t i = 30000; i < record.samples.size(); ++i) record.samples[i].utime += 86'400'000'000;
  const estimator::SeaState sea = run_spectral(record.samples);
  EXPECT_NEAR(sea.hm0_m / whole.hm0_m, 1, 0.003);
  EXPECT_NEAR(sea.tm02_s / whole.tm02_s, 1, 0.003);
  EXPECT_NEAR(sea.duration_s, 600, 1);
  EXPECT_EQ(sea.flags & flag::kTooFewWaves, 0);
}

TEST(Spectral, SaysWhenThereIsTooLittle) {
  const SeaRecord record = sea_record({.duration_s = 20}, 4);
  EXPECT_TRUE(run_spectral(record.samples).flags & flag::kTooFewWaves);
  EXPECT_TRUE(run_spectral({}).flags & flag::kTooFewWaves);
}


// The nodes of a short record lie between its samples, unless its rate happens to be a multiple of theirs.
TEST(Spectral, TellsTheSamePeriodAtAnyRate) {
  for (const double rate_Hz : {8.0, 10.0, 12.5, 20.0, 100.0})
    for (const double period_s : {6.0, 10.0}) {
      SyntheticWaves waves;
      waves.period_s = period_s;
      waves.height_m = 1;
      waves.duration_s = 120;
      waves.rate_Hz = rate_Hz;
      const estimator::SeaState sea = run_spectral(synthesize(waves, SensorErrors{}, 1).samples);
      EXPECT_NEAR(sea.tm02_s / period_s, 1, 0.01) << rate_Hz << " Hz, " << period_s << " s";
    }
}

}  // namespace
}  // namespace waverig::testing
