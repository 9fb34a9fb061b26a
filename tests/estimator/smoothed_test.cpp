#include "estimator/heave/smoothed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/method.h"
#include "lcmtypes/flags.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::Smoothed;

Collector run_smoothed(const std::vector<estimator::ImuSample>& samples) {
  Smoothed method{estimator::MethodSettings{}};
  return run(method, samples);
}

struct Limit {
  double tp_s, hm0_m, rms;
};

TEST(Smoothed, StaysWithinTheStatedErrorTheRecordsEndsIncluded) {
  for (const Limit& limit : {Limit{3, 0.5, 0.005}, {6, 1, 0.005}, {9, 1, 0.005}, {12, 1, 0.007}, {12, 4, 0.005}})
    for (const std::uint64_t seed : {1, 2}) {
      const SeaRecord record = sea_record({.tp_s = limit.tp_s, .hm0_m = limit.hm0_m}, seed);
      const Collector out = run_smoothed(record.samples);
      ASSERT_EQ(out.heaves.size(), record.samples.size());
      EXPECT_LT(rms_over_hm0(out.heaves, record, 0, out.heaves.size()), limit.rms)
          << "Tp " << limit.tp_s << " s, Hm0 " << limit.hm0_m << " m, seed " << seed;
    }
}

TEST(Smoothed, IsSoundAtTheVeryEnds) {
  double first = 0, last = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5, .duration_s = 600}, seed);
    const Collector out = run_smoothed(record.samples);
    const std::size_t n = out.heaves.size();
    first += square(rms_over_hm0(out.heaves, record, 0, 800)) / 5;
    last += square(rms_over_hm0(out.heaves, record, n - 800, n)) / 5;
  }
  EXPECT_LT(std::sqrt(first), 0.02);
  EXPECT_LT(std::sqrt(last), 0.02);
}

TEST(Smoothed, HasNoErrorOfItsOwnOnPerfectSamples) {
  const SeaRecord record = sea_record({.tp_s = 7, .hm0_m = 2, .duration_s = 600, .perfect_sensor = true}, 3);
  const Collector out = run_smoothed(record.samples);
  EXPECT_LT(rms_over_hm0(out.heaves, record, 3000, out.heaves.size() - 3000), 5e-4);
}

// Once it was taken for a sea of metres.
TEST(Smoothed, TakesNoChangeOfItsOffsetForASea) {
  for (const Limit& limit : {Limit{3, 0.5, 0.003}, {8, 1.5, 0.004}, {12, 1, 0.008}})
    for (const double change_mps2 : {0.05, -0.2, 1.0}) {
      SeaRecord record = sea_record({.tp_s = limit.tp_s, .hm0_m = limit.hm0_m, .duration_s = 600}, 1);
      for (std::size_t i = 25000; i < record.samples.size(); ++i) record.samples[i].f_B.z() -= change_mps2;
      const Collector out = run_smoothed(record.samples);
      EXPECT_LT(rms_over_hm0(out.heaves, record, 0, out.heaves.size()), limit.rms)
          << "Tp " << limit.tp_s << " s, " << change_mps2 << " m/s^2";
      EXPECT_TRUE(out.heaves[25000].flags & flag::kSpike) << change_mps2;
      EXPECT_FALSE(out.heaves[20000].flags & flag::kSpike) << change_mps2;
    }
}

// One that is too small to be found by itself bends the drift as a sea might that was not there before.
TEST(Smoothed, TakesNoSmallChangeOfItsOffsetForASea) {
  for (const Limit& limit : {Limit{3, 0.5, 0.003}, {8, 1.5, 0.007}, {12, 1, 0.012}})
    for (const int at_s : {30, 300, 570}) {
      SeaRecord record = sea_record({.tp_s = limit.tp_s, .hm0_m = limit.hm0_m, .duration_s = 600}, 1);
      for (auto i = static_cast<std::size_t>(at_s) * 100; i < record.samples.size(); ++i) record.samples[i].f_B.z() -= 0.02;
      const Collector out = run_smoothed(record.samples);
      EXPECT_LT(rms_over_hm0(out.heaves, record, 0, out.heaves.size()), limit.rms) << "Tp " << limit.tp_s << " s, at " << at_s << " s";
    }
}

// In a steep sea it leaks into the vertical with the groups of waves.
TEST(Smoothed, FindsTheGyroscopesScale) {
  for (const double scale : {-0.02, 0.02}) {
    const SeaRecord record = sea_record({.tp_s = 4, .hm0_m = 1.5, .duration_s = 900, .gyro_scale = scale}, 2);
    const Collector out = run_smoothed(record.samples);
    EXPECT_LT(rms_over_hm0(out.heaves, record, 0, out.heaves.size()), 0.0012) << scale;
  }
}

// As a rig does that turns its crank from rest: its first stroke goes to one side, and is the sea's by no spectrum.
struct Crank {
  double period_s, lasts_s = 240, rest_s = 20, radius_m = 0.4;
  double ramp_s() const { return 2 * period_s; }
  double stops_s() const { return lasts_s - rest_s; }
};
SeaRecord turned(const Crank& crank, std::uint64_t seed) {
  const double omega = 2 * kPi / crank.period_s, begins_to_stop_s = crank.stops_s() - crank.ramp_s();
  double turned_rad = 0, last_s = 0;
  return recorded({.duration_s = crank.lasts_s}, seed, [&](std::int64_t utime) {
    const double t_s = static_cast<double>(utime) * kMicrosecond;
    const Ramp up = ramp(t_s, crank.rest_s, crank.ramp_s()), down = ramp(t_s, begins_to_stop_s, crank.ramp_s());
    const double speed = omega * (up.w - down.w), speeds_up = omega * (up.dw - down.dw);
    turned_rad += (t_s - std::exchange(last_s, t_s)) * speed;
    const Vector3d radius(crank.radius_m * std::cos(turned_rad), 0, -crank.radius_m * std::sin(turned_rad));
    const Vector3d along(radius.z(), 0, -radius.x());
    BodyMotion m;
    m.position_N = radius;
    m.velocity_N = speed * along;
    m.acceleration_N = speeds_up * along - speed * speed * radius;
    return m;
  });
}

TEST(Smoothed, FollowsACrankThatBeginsAtRest) {
  for (const double period_s : {4.0, 6.0, 9.0}) {
    const Crank crank{period_s};
    double squares_m2 = 0, errors_sigma2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const SeaRecord record = turned(crank, seed);
      const Collector out = run_smoothed(record.samples);
      for (std::size_t i = 0; i < 6000; ++i, ++n) {
        const double error_m = out.heaves[i].heave_m - record.heave_m[i];
        squares_m2 += square(error_m);
        errors_sigma2 += square(error_m / out.heaves[i].heave_sigma_m);
      }
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), 0.01 * 4 * crank.radius_m / std::numbers::sqrt2) << period_s << " s";
    EXPECT_LT(std::sqrt(errors_sigma2 / n), 1) << period_s << " s";
  }
}

// Of a record that ends as the crank stops no rest tells where it stands.
TEST(Smoothed, TakesACrankThatStopsForNoChangeOfItsOffset) {
  for (const double period_s : {4.0, 6.0, 9.0}) {
    const Crank crank{period_s};
    double errors_sigma2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SeaRecord record = turned(crank, seed);
      record.samples.resize(static_cast<std::size_t>(100 * crank.stops_s()));
      const Collector out = run_smoothed(record.samples);
      for (std::size_t i = out.heaves.size() - 2000; i < out.heaves.size(); ++i, ++n)
        errors_sigma2 += square((out.heaves[i].heave_m - record.heave_m[i]) / out.heaves[i].heave_sigma_m);
    }
    EXPECT_LT(std::sqrt(errors_sigma2 / n), 3) << period_s << " s";
  }
}

// Boards laid down between runs, or a rig that is parked, rest at the runs' mean level or at another.
TEST(Smoothed, KnowsARestAtAnyLevel) {
  struct Runs {
    double tp_s, hm0_m, lasts_s, rest_s, level_m;
    double rms, error_sigma;
  };
  for (const Runs& runs : {Runs{6, 1, 60, 20, 0, 0.012, 1}, {9, 2, 60, 60, 0.5, 0.05, 2}, {4, 1, 60, 60, 0.25, 0.04, 1},
                           {6, 1, 60, 10, 0.25, 0.03, 1}, {12, 1, 300, 60, 0.25, 0.08, 2.5},
                           {3, 0.3, 120, 30, 0.15, 0.06, 1}}) {
    double squares = 0, errors_sigma2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const SeaCase sea{.tp_s = runs.tp_s, .hm0_m = runs.hm0_m, .duration_s = runs.lasts_s};
      const SeaRecord record = runs_and_rests(sea, sea, runs.rest_s, 4, seed, runs.level_m).record;
      const Collector out = run_smoothed(record.samples);
      for (std::size_t i = 0; i < out.heaves.size(); ++i, ++n) {
        const double error_m = out.heaves[i].heave_m + runs.level_m - record.heave_m[i];
        squares += square(error_m);
        errors_sigma2 += square(error_m / out.heaves[i].heave_sigma_m);
      }
    }
    EXPECT_LT(std::sqrt(squares / n), runs.rms * runs.hm0_m) << runs.tp_s << " s, " << runs.level_m << " m";
    EXPECT_LT(std::sqrt(errors_sigma2 / n), runs.error_sigma) << runs.tp_s << " s, " << runs.level_m << " m";
  }
}

// Where a run begins over two periods, noise moves the path by as much as a rest may lie off the mean level.
TEST(Smoothed, StatesThatARestsLevelIsNotKnown) {
  const SeaCase sea{.tp_s = 8, .hm0_m = 1, .duration_s = 150};
  const double level_m = sea.hm0_m / 8;
  double errors_sigma2 = 0, n = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SeaRecord record = runs_and_rests(sea, sea, 40, 3, seed, level_m, 2 * sea.tp_s).record;
    const Collector out = run_smoothed(record.samples);
    for (std::size_t i = 0; i < out.heaves.size(); ++i, ++n)
      errors_sigma2 += square((out.heaves[i].heave_m + level_m - record.heave_m[i]) / out.heaves[i].heave_sigma_m);
  }
  EXPECT_LT(std::sqrt(errors_sigma2 / n), 2.5);
}

TEST(Smoothed, GivesTheHeaveRate) {
  const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5, .duration_s = 600}, 4);
  const Collector out = run_smoothed(record.samples);
  double error = 0, truth = 0;
  for (std::size_t i = 0; i < out.heaves.size(); ++i) {
    error += square(out.heaves[i].heave_rate_mps - record.heave_rate_mps[i]);
    truth += square(record.heave_rate_mps[i]);
  }
  EXPECT_LT(std::sqrt(error / truth), 0.01);
}

TEST(Smoothed, StatesASigmaThatHolds) {
  double squared = 0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const SeaRecord record = sea_record({.tp_s = 4 + static_cast<double>(seed), .hm0_m = 0.7, .duration_s = 600}, seed);
    const Collector out = run_smoothed(record.samples);
    for (std::size_t i = 0; i < out.heaves.size(); i += 100, ++n)
      squared += square((out.heaves[i].heave_m - record.heave_m[i]) / out.heaves[i].heave_sigma_m);
  }
  EXPECT_GT(squared / n, 0.4);
  EXPECT_LT(squared / n, 1.6);
}

TEST(Smoothed, MeetsTheTrueHeightsOfSingleWaves) {
  const SeaRecord record = sea_record({.tp_s = 9, .hm0_m = 2, .duration_s = 900}, 5);
  const Collector out = run_smoothed(record.samples);
  ASSERT_GT(out.waves.size(), 80u);
  double squared = 0;
  for (const estimator::Wave& wave : out.waves) {
    const auto begin = static_cast<std::size_t>((wave.start_utime - record.samples[0].utime) / 10000);
    const auto end = begin + static_cast<std::size_t>(wave.period_s * 100) + 1;
    const auto [low, high] = std::minmax_element(record.heave_m.begin() + static_cast<std::ptrdiff_t>(begin),
                                                 record.heave_m.begin() + static_cast<std::ptrdiff_t>(end));
    squared += square(wave.height_m - (*high - *low));
    EXPECT_GT(wave.noise_sigma_m, 0);
  }
  EXPECT_LT(std::sqrt(squared / static_cast<double>(out.waves.size())), 0.02);
}

TEST(Smoothed, TreatsThePiecesBetweenGapsAsRecords) {
  const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5, .duration_s = 900}, 6);
  std::vector<estimator::ImuSample> samples;
  for (std::size_t i = 0; i < record.samples.size(); ++i)
    if (i < 30000 || i > 32000) samples.push_back(record.samples[i]);
  const Collector out = run_smoothed(samples);
  ASSERT_EQ(out.heaves.size(), samples.size());
  EXPECT_TRUE(out.heaves[30000].flags & flag::kGap);
  EXPECT_LT(rms_over_hm0(out.heaves, record, 0, out.heaves.size()), 0.01);
  for (const estimator::Wave& wave : out.waves) EXPECT_LT(wave.period_s, 20);
}

TEST(Smoothed, ALostSampleEndsNoWave) {
  const SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 600}, 3);
  std::vector<estimator::ImuSample> samples;
  for (std::size_t i = 0; i < record.samples.size(); ++i)
    if (i % 97 != 50) samples.push_back(record.samples[i]);
  const Collector whole = run_smoothed(record.samples), lost = run_smoothed(samples);
  EXPECT_EQ(lost.waves.size(), whole.waves.size());
  EXPECT_TRUE(lost.waves[3].flags & flag::kGap);
}

TEST(Smoothed, TheSampleAfterOneThatWasLeftOutSaysWhy) {
  SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 300}, 3);
  record.samples[9000].f_B.x() = std::nan("");
  const std::int64_t next = record.samples[9001].seq;
  for (const char* name : {"smoothed", "realtime"}) {
    const auto method = estimator::make_method(name, {});
    for (const estimator::HeaveSample& h : run(*method, record.samples).heaves)
      EXPECT_EQ((h.flags & flag::kRange) != 0, h.seq == next) << name << ' ' << h.seq;
  }
}

// A scale that is a twentieth wrong makes all of the sea a twentieth wrong.
TEST(Smoothed, StatesTheSensorsScaleAsPartOfHeavesSigma) {
  const SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 2, .duration_s = 600}, 3);
  for (const char* name : {"smoothed", "realtime"}) {
    const auto variance_with = [&](double slope_sigma) {
      estimator::MethodSettings settings;
      settings.sensor.accel_slope_sigma = slope_sigma;
      return square(run(*estimator::make_method(name, settings), record.samples).heaves.back().heave_sigma_m);
    };
    EXPECT_NEAR(variance_with(0.05) - variance_with(0), square(0.05 * 2 / 4.0), 0.3 * square(0.05 * 2 / 4.0)) << name;
  }
}

// Two samples a microsecond apart differ by their noise, which is no slope.
TEST(Smoothed, SamplesCloseTogetherTellNoSlope) {
  const SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 600}, 3);
  std::vector<estimator::ImuSample> samples;
  RandomStream noise(5, "close");
  for (const auto& sample : record.samples) {
    samples.push_back(sample);
    if (sample.seq % 2000 != 1000) continue;
    samples.push_back(sample);
    samples.back().utime += 1;
    samples.back().f_B.z() += noise.gaussian(0.02);
  }
  EXPECT_LT(rms_over_hm0(run_smoothed(samples).heaves, record, 0, samples.size()), 0.005);
}

TEST(Smoothed, TakesRecordsOfAnyLength) {
  const SeaRecord record = sea_record({.duration_s = 30}, 7);
  for (const std::size_t n : {0u, 1u, 2u, 49u, 50u, 51u, 120u, 700u, 3000u}) {
    const std::vector<estimator::ImuSample> few(record.samples.begin(), record.samples.begin() + static_cast<std::ptrdiff_t>(n));
    const Collector out = run_smoothed(few);
    ASSERT_EQ(out.heaves.size(), n);
    for (const auto& h : out.heaves) ASSERT_TRUE(std::isfinite(h.heave_m) && std::isfinite(h.heave_sigma_m)) << n;
  }
}

TEST(Smoothed, StaysCalmOnACalm) {
  std::vector<estimator::ImuSample> samples;
  RandomStream noise(1, "calm");
  for (int i = 0; i < 30000; ++i) {
    estimator::ImuSample s;
    s.utime = 1000 + i * 10000;
    s.seq = i;
    s.f_B = Vector3d(0.02 + noise.gaussian(0.024), noise.gaussian(0.024), -kStandardGravity + noise.gaussian(0.024));
    s.w_NB_B = Vector3d(noise.gaussian(0.003), noise.gaussian(0.003), noise.gaussian(0.003));
    samples.push_back(s);
  }
  const Collector out = run_smoothed(samples);
  for (const auto& h : out.heaves) ASSERT_LT(std::abs(h.heave_m), 0.05);
}

}  // namespace
}  // namespace waverig::testing
