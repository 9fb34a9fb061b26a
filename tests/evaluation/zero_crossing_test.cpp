#include "estimator/evaluation/zero_crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "estimator/evaluation/csv_reader.h"
#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/heave_spectrum.h"
#include "motion/kinematics/random.h"
#include "tests/evaluation/recordings.h"

namespace waverig::evaluation {
namespace {

struct Series {
  std::vector<std::int64_t> utime;
  std::vector<double> heave_m;
};

template <class Function>
Series sampled(double duration_s, double rate_hz, Function heave_m) {
  Series s;
  for (int i = 0; i < std::lround(duration_s * rate_hz); ++i) {
    s.utime.push_back(1'000'000'000 + std::llround(i / rate_hz * 1e6));
    s.heave_m.push_back(heave_m(i / rate_hz));
  }
  return s;
}

double harmonic(double t, double period_s) { return std::sin(2 * std::numbers::pi * t / period_s - 0.4); }

TEST(ZeroCrossing, CountsASineExactly) {
  const Series s = sampled(100.1, 50, [](double t) { return 0.7 * harmonic(t, 5); });
  const auto waves = count_waves(s.utime, s.heave_m, {.interpolate_extremes = true});
  ASSERT_EQ(waves.size(), 19u);
  for (const CountedWave& wave : waves) {
    EXPECT_NEAR(wave.period_s, 5, 2e-3);
    EXPECT_NEAR(wave.height_m, 1.4, 1e-5);
  }
  const WaveStatistics statistics = statistics_of(waves);
  EXPECT_NEAR(statistics.h13_m, 1.4, 1e-5);
  EXPECT_NEAR(statistics.mean_period_s, 5, 1e-4);
  EXPECT_NEAR(statistics.std_height_m, 0, 1e-5);
}

TEST(ZeroCrossing, InterpolatesExtremesThatCoarseSamplesMiss) {
  const Series s = sampled(200, 1.28, [](double t) { return harmonic(t, 5.3); });
  const auto plain = statistics_of(count_waves(s.utime, s.heave_m));
  const auto refined = statistics_of(count_waves(s.utime, s.heave_m, {.interpolate_extremes = true}));
  EXPECT_LT(plain.mean_height_m, 1.97);
  EXPECT_NEAR(refined.mean_height_m, 2, 0.02);
}

TEST(ZeroCrossing, IgnoresMeanAndTrendWhereAsked) {
  const Series s = sampled(300, 10, [](double t) { return 3 + 0.02 * t + harmonic(t, 6); });
  EXPECT_LT(count_waves(s.utime, s.heave_m).size(), 40u);
  const auto detrended =
      statistics_of(count_waves(s.utime, s.heave_m, {.remove_trend = true, .interpolate_extremes = true}));
  EXPECT_EQ(detrended.waves, 49);
  EXPECT_NEAR(detrended.mean_height_m, 2, 1e-2);
}

TEST(ZeroCrossing, CountsARippleOnlyWithoutADeadBand) {
  const Series s = sampled(
      200, 20, [](double t) { return harmonic(t, 8) + 0.06 * std::sin(2 * std::numbers::pi * t * 3); });
  EXPECT_GT(count_waves(s.utime, s.heave_m).size(), 30u);
  const auto waves = count_waves(s.utime, s.heave_m, {.dead_band_m = 0.1});
  EXPECT_EQ(waves.size(), 24u);
  for (const CountedWave& wave : waves) EXPECT_NEAR(wave.period_s, 8, 0.3);
}

// Four crests; between the second and the third the trough stays within the dead band.
TEST(ZeroCrossing, ATroughWithinTheDeadBandPartsNoWaves) {
  const Series s = sampled(20, 50, [](double t) {
    const double h = harmonic(t, 5);
    return t > 6.25 && t < 11.25 && h < 0 ? 0.05 * h : h;
  });
  const std::size_t all = count_waves(s.utime, s.heave_m, {.remove_mean = false}).size();
  EXPECT_EQ(count_waves(s.utime, s.heave_m, {.remove_mean = false, .dead_band_m = 0.1}).size(), all - 1);
}

TEST(ZeroCrossing, LetsNoWaveReachOverAGap) {
  Series s = sampled(100, 10, [](double t) { return harmonic(t, 5); });
  const std::size_t whole = count_waves(s.utime, s.heave_m).size();
  Series missing = s;
  missing.utime.erase(missing.utime.begin() + 520, missing.utime.begin() + 530);
  missing.heave_m.erase(missing.heave_m.begin() + 520, missing.heave_m.begin() + 530);
  EXPECT_EQ(count_waves(missing.utime, missing.heave_m).size(), whole - 1);
  s.heave_m[525] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_waves(s.utime, s.heave_m).size(), whole - 1);
}

TEST(ZeroCrossing, TakesExactlyTheThirdOfTheWaves) {
  std::vector<CountedWave> waves;
  for (const double height : {4.0, 1.0, 3.0, 2.0})
    waves.push_back({0, height, height, height / 2, -height / 2});
  // 4/3 waves: all of the 4 m, a third of the 3 m.
  EXPECT_NEAR(statistics_of(waves).h13_m, (4 + 3 / 3.0) / (4 / 3.0), 1e-12);
  EXPECT_NEAR(statistics_of(waves).h110_m, 4, 1e-12);
  EXPECT_EQ(statistics_of(waves).hmax_m, 4);
}

TEST(ZeroCrossing, FindsNothingInNothing) {
  EXPECT_TRUE(count_waves({}, {}).empty());
  const std::vector<std::int64_t> utime = {0, 1};
  const std::vector<double> still = {0, 0}, unknown(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(count_waves(utime, still).empty());
  EXPECT_TRUE(count_waves(utime, unknown).empty());
  EXPECT_EQ(statistics_of({}).waves, 0);
  EXPECT_TRUE(std::isnan(statistics_of({}).h13_m));
}

// A wave has a crest above and a trough below the zero line, waves follow each other, whatever the series.
TEST(ZeroCrossing, MakesWellFormedWavesOfAnyNoise) {
  for (int seed = 0; seed < 100; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "zero crossing");
    double state = 0;
    const Series s = sampled(60, 5, [&](double) { return state = 0.9 * state + random.gaussian(); });
    const auto waves = count_waves(s.utime, s.heave_m,
                                   {.dead_band_m = 0.1 * (seed % 3), .interpolate_extremes = seed % 2 == 0});
    for (std::size_t k = 0; k < waves.size(); ++k) {
      EXPECT_GT(waves[k].crest_m, 0);
      EXPECT_LT(waves[k].trough_m, 0);
      EXPECT_NEAR(waves[k].height_m, waves[k].crest_m - waves[k].trough_m, 1e-12);
      EXPECT_GT(waves[k].period_s, 0);
      if (k == 0) continue;
      EXPECT_NEAR(static_cast<double>(waves[k].start_utime - waves[k - 1].start_utime) * 1e-6,
                  waves[k - 1].period_s, 1e-9);
    }
  }
}

// Datawell Directional Waverider, twelve half hours, and what the buoy's own software reported of them.
class Waverider : public ::testing::Test {
 protected:
  struct HalfHour {
    std::string record;
    HeaveSeries heave;
    std::map<std::string, double> reported;
    double mean_m = 0;
  };

  void SetUp() override {
    const auto table = recordings() / "waverider_statistics.csv";
    WAVERIG_NEEDS_RECORDING(table);
    CsvReader csv(table);
    while (csv.next()) {
      HalfHour h;
      h.record = csv.cell(0);
      for (int column = 1; column < static_cast<int>(csv.columns().size()); ++column)
        h.reported[csv.columns()[static_cast<std::size_t>(column)]] = csv.number(column);
      h.heave = read_heave_csv(recordings() / (h.record + ".heave.csv"));
      h.mean_m = std::accumulate(h.heave.heave_m.begin(), h.heave.heave_m.end(), 0.0) /
                 static_cast<double>(h.heave.heave_m.size());
      half_hours.push_back(h);
    }
    ASSERT_EQ(half_hours.size(), 12u);
  }

  static double percent_above(double value, double reported) { return 100 * (value / reported - 1); }

  std::vector<HalfHour> half_hours;
};

TEST_F(Waverider, HeightsAndPeriodsAgreeWithTheBuoyWithinHalfAPercentOnAverage) {
  double h13 = 0, h110 = 0, t13 = 0, period = 0, mean = 0;
  for (const HalfHour& h : half_hours) {
    const WaveStatistics s = statistics_of(count_waves(h.heave.utime, h.heave.heave_m));
    EXPECT_NEAR(s.hmax_m, h.reported.at("hmax_m"), 0.005) << h.record;
    h13 += percent_above(s.h13_m, h.reported.at("h13_m")) / 12;
    h110 += percent_above(s.h110_m, h.reported.at("h110_m")) / 12;
    t13 += percent_above(s.t13_s, h.reported.at("t13_s")) / 12;
    period += percent_above(s.mean_period_s, h.reported.at("mean_period_s")) / 12;
    mean += percent_above(s.mean_height_m, h.reported.at("mean_height_m")) / 12;
  }
  EXPECT_LT(std::abs(h13), 0.5);
  EXPECT_LT(std::abs(h110), 0.5);
  EXPECT_LT(std::abs(t13), 0.5);
  EXPECT_LT(std::abs(period), 0.5);
  EXPECT_LT(std::abs(mean), 0.5);
}

TEST_F(Waverider, Hm0IsFourStandardDeviationsOfEachRecord) {
  for (const HalfHour& h : half_hours) {
    double squares = 0;
    for (const double z : h.heave.heave_m) squares += estimator::square(z - h.mean_m);
    const double hm0_m = 4 * std::sqrt(squares / static_cast<double>(h.heave.heave_m.size()));
    EXPECT_NEAR(sea_of(spectrum_of(h.heave.utime, h.heave.heave_m)).hm0_m / hm0_m, 1, 5e-4) << h.record;
  }
}

// What is left in the mean height is the zero line: at a resolution of 1 cm some waves only touch zero, and
// the sign of less than a millimetre decides whether they are one wave or two. With the mean of the half hour
// before, which is what a buoy that reports at once can know, eleven of twelve half hours give the buoy's own
// counts and figures.
TEST_F(Waverider, MeanOfTheHalfHourBeforeAsZeroLineGivesTheBuoysOwnFigures) {
  int same = 0;
  for (std::size_t k = 0; k < half_hours.size(); ++k) {
    const HalfHour& h = half_hours[k];
    const double level_m = k == 0 ? 0.0 : half_hours[k - 1].mean_m;
    const WaveStatistics s = statistics_of(
        count_waves(h.heave.utime, h.heave.heave_m, {.remove_mean = false, .level_m = level_m}));
    const double resolution = k == 0 ? 0.0051 : 0.000051;  // the first half hour is reported to 1 cm only
    if (static_cast<double>(s.waves) != h.reported.at("waves")) continue;
    EXPECT_NEAR(s.mean_height_m, h.reported.at("mean_height_m"), 0.000051) << h.record;
    EXPECT_NEAR(s.h13_m, h.reported.at("h13_m"), resolution) << h.record;
    EXPECT_NEAR(s.h110_m, h.reported.at("h110_m"), resolution) << h.record;
    ++same;
  }
  EXPECT_EQ(same, 11);
}

}  // namespace
}  // namespace waverig::evaluation
