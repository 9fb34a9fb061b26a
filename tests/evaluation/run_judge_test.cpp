#include "estimator/evaluation/run_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/evaluation/cells.h"
#include "estimator/evaluation/run_record.h"
#include "lcmtypes/flags.h"
#include "lcmtypes/phase.h"
#include "motion/envelope.h"

namespace waverig::evaluation {
namespace {

constexpr double kPeriod = 6, kHeight = 0.6, kOmega = 2 * std::numbers::pi / kPeriod;
constexpr std::int64_t kSecond = 1'000'000;

run_t phase(Phase p, std::int64_t utime) {
  run_t m{};
  m.utime = utime;
  m.phase = static_cast<std::int32_t>(p);
  m.period_s = kPeriod;
  m.height_m = kHeight;
  m.repeat = 2;
  return m;
}

double true_heave(std::int64_t utime) { return 0.29 * std::cos(kOmega * static_cast<double>(utime) * 1e-6); }

truth_t truth(std::int64_t utime) {
  truth_t m{};
  m.utime = utime;
  m.heave_m = true_heave(utime);
  m.heave_rate_mps = -0.29 * kOmega * std::sin(kOmega * static_cast<double>(utime) * 1e-6);
  return m;
}

estimator::Wave wave_at(std::int64_t utime, double height_m) {
  estimator::Wave w;
  w.start_utime = utime;
  w.period_s = kPeriod;
  w.height_m = height_m;
  return w;
}

// 12 s of ramp, 48 s steady, 12 s of ramp; truth at 50 Hz.
template <class EachTick>
void play(RunJudge& judge, EachTick each_tick) {
  judge.add(phase(Phase::kRampIn, 0));
  for (std::int64_t t = 0; t <= 72 * kSecond; t += 20'000) {
    if (t == 12 * kSecond) judge.add(phase(Phase::kSteady, t));
    if (t == 60 * kSecond) judge.add(phase(Phase::kRampOut, t));
    judge.add(truth(t));
    each_tick(t);
  }
}

TEST(RunJudge, JudgesOnlyWholeWavesOfTheSteadyPart) {
  RunJudge judge("run", {});
  play(judge, [&](std::int64_t t) {
    if (t % (6 * kSecond) == 0) judge.add("m", wave_at(t, 0.59));
  });
  const auto results = judge.finish();
  ASSERT_EQ(results.size(), 1u);
  const RunResult& r = results[0];
  EXPECT_EQ(r.statistics.waves, 8);  // 12, 18, … 54 s
  EXPECT_EQ(r.excluded_waves, 13 - 8);
  EXPECT_EQ(r.repeat, 2);
  EXPECT_EQ(r.period_s, kPeriod);
  EXPECT_NEAR(r.statistics.mean_true_height_m, 0.58, 1e-8);
  EXPECT_NEAR(r.statistics.rmse_m, 0.01, 1e-8);
  EXPECT_NEAR(r.statistics.error_rate_percent, 100 * 0.01 / 0.6, 1e-9);
  EXPECT_NEAR(r.true_hm0_m, 4 * 0.29 / std::sqrt(2), 1e-3);
  EXPECT_NEAR(r.true_tm02_s, kPeriod, 1e-3);
}

TEST(RunJudge, CountsAWaveThatWasSentTwiceOnce) {
  RunJudge judge("run", {});
  play(judge, [&](std::int64_t t) {
    for (int times = 0; times < 2 && t % (6 * kSecond) == 0; ++times) judge.add("m", wave_at(t, 0.59));
  });
  EXPECT_EQ(judge.finish().at(0).statistics.waves, 8);
}

// In the ramps the arm's plane shall lie elsewhere: what is said of the whole record is held against the
// steady part alone.
TEST(RunJudge, HoldsADirectionAgainstTheTruthOfTheSteadyPart) {
  const auto true_direction_with = [](bool ramps_elsewhere) {
    RunJudge judge("run", {});
    judge.add(phase(Phase::kRampIn, 0));
    for (std::int64_t t = 0; t <= 72 * kSecond; t += 20'000) {
      if (t == 12 * kSecond) judge.add(phase(Phase::kSteady, t));
      if (t == 60 * kSecond) judge.add(phase(Phase::kRampOut, t));
      const bool ramp = t < 12 * kSecond || t > 60 * kSecond;
      truth_t m = truth(t);
      (ramp && ramps_elsewhere ? m.east_m : m.north_m) =
          0.29 * std::sin(kOmega * 1e-6 * static_cast<double>(t));
      judge.add(m);
    }
    estimator::SeaState sea;
    sea.duration_s = 72;
    sea.mean_direction_rad = 0;
    judge.add("m", sea);
    return judge.finish().at(0).seas.at(0).direction.mean_direction_rad;
  };
  EXPECT_NEAR(true_direction_with(false), std::numbers::pi,
              1e-3);  // the crest runs north: it comes from the south
  EXPECT_EQ(true_direction_with(true), true_direction_with(false));
}

TEST(RunJudge, LeavesOutWavesCutByTheRecordsEdge) {
  RunJudge judge("run", {});
  estimator::Wave cut = wave_at(18 * kSecond, 0.3);
  cut.flags = flag::kIncomplete;
  judge.add("m", cut);
  play(judge, [](std::int64_t) {});
  EXPECT_EQ(judge.finish().at(0).excluded_waves, 1);
}

TEST(RunJudge, FindsGainLagAndErrorOfTheHeave) {
  RunJudge judge("run", {});
  const std::int64_t lag = 200'000;
  play(judge, [&](std::int64_t t) {
    estimator::HeaveSample h;
    h.utime = t + 7'000;  // between the samples of the truth
    h.heave_m = 5 + 1.1 * true_heave(h.utime - lag);
    judge.add("late", h);
    h.heave_m = 1 + true_heave(h.utime);
    judge.add("true", h);
  });
  const auto results = judge.finish();
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].method, "late");
  EXPECT_NEAR(results[0].heave_gain, 1.1, 1e-6);
  EXPECT_NEAR(results[0].heave_lag_s, 0.2, 1e-6);
  EXPECT_NEAR(results[1].heave_rmse_m, 0, 1e-7);
  EXPECT_NEAR(results[1].heave_gain, 1, 1e-6);
  EXPECT_NEAR(results[1].heave_lag_s, 0, 1e-6);
}

TEST(RunJudge, DoesNotMindInWhichOrderTheChannelsCome) {
  const auto result = [](bool late) {
    RunJudge judge("run", {});
    std::vector<estimator::HeaveSample> held;
    play(judge, [&](std::int64_t t) {
      estimator::HeaveSample h;
      h.utime = t;
      h.heave_m = 0.9 * true_heave(t - 50'000);
      if (late)
        held.push_back(h);
      else
        judge.add("m", h);
    });
    for (const auto& h : held) judge.add("m", h);
    return judge.finish().at(0).heave_rmse_m;
  };
  EXPECT_GT(result(false), 0.01);
  EXPECT_NEAR(result(true), result(false), 1e-12);
}

TEST(RunJudge, StatesTheBoundOfTheOrderedPeriod) {
  RunJudge judge("run", {.noise_density_mps2_rthz = 3e-3, .sample_rate_hz = 100});
  play(judge, [&](std::int64_t t) {
    if (t == 18 * kSecond) judge.add("m", wave_at(t, 0.58));
  });
  EXPECT_NEAR(judge.finish().at(0).statistics.bound_std_m, motion::height_sigma_bound_m(kPeriod, 3e-3), 1e-9);
}

TEST(RunJudge, PassesOnTheBoundOfHeaveToTheMethodItIsMeantFor) {
  RunJudge judge("run", {.heave_bound_m = {{"m", 0.004}}});
  play(judge, [&](std::int64_t t) {
    if (t != 18 * kSecond) return;
    judge.add("m", wave_at(t, 0.58));
    judge.add("other", wave_at(t, 0.58));
  });
  const auto results = judge.finish();
  EXPECT_EQ(results.at(0).heave_bound_m, 0.004);
  EXPECT_TRUE(std::isnan(results.at(1).heave_bound_m));
}

// Any program may publish: nonsense is counted as excluded, never followed.
TEST(RunJudge, IsNotLedAstrayByNonsenseOnTheBus) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kHuge = 1e300;
  constexpr auto kLast = std::numeric_limits<std::int64_t>::max(),
                 kFirst = std::numeric_limits<std::int64_t>::min();
  RunJudge judge("run", {.noise_density_mps2_rthz = 1e-3});
  play(judge, [&](std::int64_t t) {
    if (t != 18 * kSecond) return;
    for (const double period_s : {kNan, -1.0, 0.0, kHuge})
      for (const std::int64_t start : {t, kLast, kFirst}) {
        estimator::Wave wave = wave_at(start, 0.6);
        wave.period_s = period_s;
        judge.add("m", wave);
        estimator::SeaState sea;
        sea.start_utime = start;
        sea.duration_s = period_s;
        judge.add("m", sea);
        estimator::HeaveSample heave;
        heave.utime = start;
        heave.heave_m = period_s;
        judge.add("h", heave);
      }
    judge.add("m", wave_at(t + 1, kNan));
    judge.add("m", wave_at(t, 0.58));
  });
  run_t strange = phase(Phase::kStopped, kLast);
  strange.period_s = kHuge;
  judge.add(strange);
  const auto results = judge.finish();
  EXPECT_EQ(results.at(1).method, "m");
  EXPECT_EQ(results.at(1).statistics.waves, 1);
  EXPECT_TRUE(std::isnan(results.at(1).statistics.bound_std_m));
}

TEST(RunJudge, CountsTheWavesOfAMethodThatGivesHeaveOnly) {
  RunJudge judge("run", {});
  play(judge, [&](std::int64_t t) {
    estimator::HeaveSample h;
    h.utime = t;
    h.heave_m = 1.02 * true_heave(t);
    judge.add("theirs", h);
  });
  const RunResult r = judge.finish().at(0);
  EXPECT_EQ(r.statistics.waves, 7);  // from up-crossing to up-crossing, 16.5 s to 58.5 s
  EXPECT_NEAR(r.statistics.mean_error_percent, 2, 0.01);
  EXPECT_NEAR(r.statistics.mean_period_s, kPeriod, 1e-3);
}

// Its heave is noise then, in which anything that counts crossings sees waves.
TEST(RunJudge, BelievesAMethodThatTellsWavesThatThereAreNone) {
  RunJudge judge("run", {.tells_waves = [](std::string_view method) { return method == "ours"; }});
  play(judge, [&](std::int64_t t) {
    estimator::HeaveSample h;
    h.utime = t;
    h.heave_m = 1.02 * true_heave(t);
    judge.add("ours", h);
    judge.add("theirs", h);
  });
  const auto results = judge.finish();
  EXPECT_EQ(results.at(0).statistics.waves, 0);
  EXPECT_EQ(results.at(0).statistics.flags, flag::kTooFewWaves);
  EXPECT_NEAR(results.at(0).heave_gain, 1.02, 1e-6);
  EXPECT_EQ(results.at(1).statistics.waves, 7);
}

RunResult of_heave(double gain, double sigma_m, std::int64_t from, std::int64_t to,
                   JudgeSettings settings = {}) {
  RunJudge judge("run", settings);
  play(judge, [&](std::int64_t t) {
    estimator::HeaveSample h;
    h.utime = t;
    h.heave_m = gain * true_heave(t);
    h.heave_sigma_m = sigma_m;
    if (t >= from && t < to) judge.add("theirs", h);
  });
  return judge.finish().at(0);
}

// A heave that is a tenth too low by its scale, as its program says with 3 cm of 30: U of the mean holds the
// error.
TEST(RunJudge, CarriesAStatedSigmaOfHeaveAsCommonToAllWaves) {
  const RunResult r = of_heave(0.9, 0.03, 0, 72 * kSecond);
  EXPECT_NEAR(r.waves.at(0).wave.calibration_sigma_m, 0.06, 1e-12)
      << "crest and trough, in opposite directions";
  EXPECT_NEAR(r.statistics.expanded_uncertainty_m, 0.12, 1e-3);
  EXPECT_GT(r.statistics.expanded_uncertainty_m,
            std::abs(r.statistics.mean_height_m - r.statistics.mean_true_height_m));
  for (const double nothing : {0.0, estimator::kUnknown})
    EXPECT_TRUE(std::isnan(of_heave(0.9, nothing, 0, 72 * kSecond).statistics.expanded_uncertainty_m))
        << nothing;
}

TEST(RunJudge, FlagsAHeaveThatMissesMoreThanOneWaveOfTheSteadyPart) {
  const RunResult whole = of_heave(1, 0.01, 0, 72 * kSecond),
                  late = of_heave(1, 0.01, 17 * kSecond, 72 * kSecond),
                  third = of_heave(1, 0.01, 0, 28 * kSecond);
  EXPECT_NEAR(whole.heave_coverage, 1, 1e-9);
  EXPECT_EQ(whole.statistics.flags & flag::kGap, 0);
  EXPECT_EQ(late.statistics.flags & flag::kGap, 0) << "5 s of 6 s waves";
  EXPECT_NEAR(third.heave_coverage, 1.0 / 3, 1e-3);
  EXPECT_NE(third.statistics.flags & flag::kGap, 0);
  EXPECT_NE(cells_of(std::vector{whole, third}).at(0).statistics.flags & flag::kGap, 0);
}

// Half a wave late and half a wave early is upside down both times.
TEST(RunJudge, PoolsAHeaveUpsideDownAsUpsideDown) {
  RunResult late = of_heave(-1, 0.01, 0, 72 * kSecond), early = late;
  EXPECT_NEAR(late.heave_gain, 1, 1e-6);
  EXPECT_NEAR(std::abs(late.heave_lag_s), kPeriod / 2, 1e-3);
  early.heave_lag_s = -late.heave_lag_s;
  const CellResult cell = cells_of(std::vector{late, early}).at(0);
  EXPECT_NEAR(cell.heave_gain, 1, 1e-6);
  EXPECT_NEAR(std::abs(cell.heave_lag_s), kPeriod / 2, 1e-3);
  const RunResult upright = of_heave(1, 0.01, 0, 72 * kSecond);
  EXPECT_NEAR(cells_of(std::vector{late, upright}).at(0).heave_gain, 0, 1e-3) << "one of each: they cancel";
  EXPECT_NEAR(cells_of(std::vector{upright}).at(0).heave_lag_s, upright.heave_lag_s, 1e-12);
}

TEST(RunJudge, PassesOnWhatMovedTheSensor) {
  const RunResult r = of_heave(1, 0.01, 0, 72 * kSecond, {.motion = Motion::kSea});
  EXPECT_EQ(r.motion, Motion::kSea);
  EXPECT_EQ(cells_of(std::vector{r}).at(0).motion, Motion::kSea);
}

TEST(RunJudge, WithoutTruthOrSteadyPartJudgesNothing) {
  RunJudge judge("run", {});
  judge.add("m", wave_at(0, 1));
  const auto results = judge.finish();
  EXPECT_EQ(results.at(0).statistics.waves, 0);
  EXPECT_EQ(results.at(0).excluded_waves, 1);
}

TEST(RunJudge, JudgesARecordLikeTheMessagesThemselves) {
  RunJudge live("r", {});
  RunRecord record;
  record.run = "r";
  record.period_s = kPeriod;
  record.height_m = kHeight;
  record.repeat = 2;
  record.steady_begin_utime = 12 * kSecond;
  record.steady_end_utime = 60 * kSecond;
  play(live, [&](std::int64_t t) {
    const truth_t m = truth(t);
    TruthSample sample;
    sample.utime = m.utime;
    sample.heave_m = m.heave_m;
    sample.heave_rate_mps = m.heave_rate_mps;
    record.truth.push_back(sample);
    estimator::HeaveSample h;
    h.utime = t;
    h.heave_m = 0.95 * true_heave(t - 30'000);
    live.add("m", h);
    record.heave["m"].push_back(h);
    if (t % (6 * kSecond) == 0) {
      live.add("m", wave_at(t, 0.57));
      record.waves["m"].push_back(wave_at(t, 0.57));
    }
  });
  const RunResult a = live.finish().at(0), b = judge(record, {}).at(0);
  EXPECT_EQ(a.statistics.waves, b.statistics.waves);
  EXPECT_EQ(a.statistics.rmse_m, b.statistics.rmse_m);
  EXPECT_EQ(a.heave_rmse_m, b.heave_rmse_m);
  EXPECT_EQ(a.excluded_waves, b.excluded_waves);
}

TEST(TruthSeries, LeavesOutWhatIsNoNumberAndWhatComesLate) {
  TruthSeries truth;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::int64_t t = 0; t <= 10; ++t) {
    if (t == 5) {
      truth.add(t * kSecond, nan, 1);
      truth.add(t * kSecond, 5, nan);
      truth.add(2 * kSecond, 100, 1);
    } else {
      truth.add(t * kSecond, static_cast<double>(t), 1);
    }
  }
  EXPECT_EQ(truth.size(), 10u);
  for (double t = 0; t <= 10; t += 0.25) EXPECT_NEAR(truth.at(std::llround(t * 1e6)).heave_m, t, 1e-9);
}

TEST(TruthSeries, FindsAnExtremeBetweenItsSamples) {
  TruthSeries series;
  for (int i = 0; i <= 40; ++i) {  // 4 Hz only
    const double t = 0.25 * i + 0.1;
    series.add(std::llround(t * 1e6), std::sin(kOmega * t), kOmega * std::cos(kOmega * t));
  }
  EXPECT_NEAR(series.height_m(1 * kSecond, 7 * kSecond), 2, 5e-5);
  EXPECT_TRUE(std::isnan(series.height_m(6 * kSecond, 12 * kSecond)));
  EXPECT_NEAR(series.at(1'234'567).heave_m, std::sin(kOmega * 1.234567), 2e-5);
  EXPECT_TRUE(std::isnan(series.at(0).heave_m));
}

}  // namespace
}  // namespace waverig::evaluation
