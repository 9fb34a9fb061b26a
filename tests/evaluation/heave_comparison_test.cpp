#include "estimator/evaluation/heave_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "estimator/evaluation/heave_against_truth.h"
#include "estimator/evaluation/high_pass.h"
#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::evaluation {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

TEST(HeaveComparison, RecoversGainAndLagOfAHarmonic) {
  const double w = kTwoPi / 7;
  HeaveComparison c;
  for (int i = 0; i < 7000; ++i) {
    const double t = 0.01 * i;
    c.add(3 + 0.93 * std::sin(w * (t - 0.35)), std::sin(w * t), w * std::cos(w * t));
  }
  EXPECT_NEAR(c.gain(), 0.93, 1e-9);
  EXPECT_NEAR(c.lag_s(), 0.35, 1e-9);
  EXPECT_NEAR(c.true_std_m(), std::sqrt(0.5), 1e-6);
  const double amplitude = std::abs(std::polar(0.93, -w * 0.35) - 1.0);
  EXPECT_NEAR(c.rmse_m(), amplitude / std::sqrt(2), 1e-6);
}

TEST(HeaveComparison, SigmaRatioIsOneForAnHonestEstimate) {
  RandomStream random(1, "sigma");
  HeaveComparison honest, sure;
  for (int i = 0; i < 20000; ++i) {
    const double t = 0.01 * i, sigma = i < 10000 ? 0.1 : 0.02, e = random.gaussian(sigma);
    honest.add(std::sin(t) + e, std::sin(t), std::cos(t), sigma);
    sure.add(std::sin(t) + e, std::sin(t), std::cos(t), sigma / 2);
  }
  EXPECT_NEAR(honest.sigma_ratio(), 1, 0.02);
  EXPECT_NEAR(sure.sigma_ratio(), 2, 0.04);
}

// Two samples a wave, always the same: any gain would do.
TEST(HeaveComparison, KnowsNoGainOfSamplesThatMeetTheSamePointsOfEachWave) {
  HeaveComparison c;
  for (int i = 0; i < 100; ++i) {
    const double phase = 0.3 + std::numbers::pi * i + 1e-6 * i;
    c.add(0.9 * std::sin(phase), std::sin(phase), 1.5 * std::cos(phase));
  }
  EXPECT_TRUE(std::isnan(c.gain()));
  EXPECT_TRUE(std::isnan(c.lag_s()));
  EXPECT_LT(c.rmse_m(), 0.1);
}

TEST(HeaveComparison, KnowsNothingOfNothing) {
  const HeaveComparison c;
  EXPECT_TRUE(std::isnan(c.rmse_m()));
  EXPECT_TRUE(std::isnan(c.gain()));
  EXPECT_TRUE(std::isnan(c.lag_s()));
  EXPECT_TRUE(std::isnan(c.sigma_ratio()));
}

// |H|^2 of a second-order Butterworth, 1 / (1 + (fc / f)^4), since the series is filtered forward and
// backward.
TEST(HighPass, HasTheGainOfButterworthSquaredAndNoPhase) {
  const double rate_hz = 100, cut_off_hz = 0.12;
  for (const double f : {0.03, 0.12, 0.2, 0.5, 2.0}) {
    std::vector<double> x, wanted;
    const double gain = 1 / (1 + std::pow(cut_off_hz / f, 4));
    for (int i = 0; i < 60000; ++i) {
      x.push_back(std::sin(kTwoPi * f * i / rate_hz));
      wanted.push_back(gain * x.back());
    }
    const auto y = high_passed(x, rate_hz, cut_off_hz);
    ASSERT_EQ(y.size(), x.size());
    for (std::size_t i = 20000; i < 40000; i += 7) EXPECT_NEAR(y[i], wanted[i], 2e-3) << f;
  }
}

TEST(HighPass, TakesOffsetAndSlopeAwayUpToTheEnds) {
  std::vector<double> x;
  for (int i = 0; i < 10000; ++i) x.push_back(5 - 0.001 * i);
  for (const double y : high_passed(x, 100, 0.12)) EXPECT_NEAR(y, 0, 1e-6);
  EXPECT_TRUE(high_passed({}, 100, 1).empty());
}

HeaveSeries series(double rate_hz, double duration_s, double offset_m, double drift_mps) {
  HeaveSeries s;
  for (int i = 0; i < static_cast<int>(rate_hz * duration_s); ++i) {
    const double t = i / rate_hz;
    s.utime.push_back(1'000'000 + std::llround(t * 1e6));
    s.heave_m.push_back(offset_m + drift_mps * t + 0.5 * std::sin(kTwoPi * t / 3));
    s.heave_sigma_m.push_back(estimator::kUnknown);
  }
  return s;
}

TEST(HeaveAgainstTruth, ComparesSeriesOfDifferentRatesAndDrifts) {
  const HeaveSeries truth = series(100, 100, 1.2, 0), heave = series(285.7, 90, 0, 0.01);
  EXPECT_GT(compare_with_truth(heave, truth, {}).rmse_m(), 0.2);
  const auto c = compare_with_truth(heave, truth, {.high_pass_hz = 0.05});
  EXPECT_LT(c.rmse_m(), 0.002);
  EXPECT_NEAR(c.gain(), 1, 2e-3);
  EXPECT_NEAR(c.lag_s(), 0, 2e-3);
}

TEST(HeaveAgainstTruth, LeavesOutWhatIsUnknownOrAtRest) {
  HeaveSeries truth = series(100, 100, 0, 0);
  const HeaveSeries heave = truth;
  for (int i = 3000; i < 3500; ++i) truth.heave_m[static_cast<std::size_t>(i)] = estimator::kUnknown;
  truth.moving.assign(truth.utime.size(), true);
  for (int i = 0; i < 2000; ++i) truth.moving[static_cast<std::size_t>(i)] = false;
  const auto c = compare_with_truth(heave, truth, {});
  EXPECT_NEAR(c.samples(), 10000 - 2000 - 500, 4);
  EXPECT_LT(c.rmse_m(), 1e-3);
}

// The straight line over a gap is nobody's estimate, and nobody's truth.
TEST(HeaveAgainstTruth, LeavesOutTheGapsOfEither) {
  const HeaveSeries whole = series(100, 100, 0, 0);
  HeaveSeries gap;
  for (std::size_t i = 0; i < whole.utime.size(); ++i) {
    if (i > 4000 && i < 6000) continue;
    gap.utime.push_back(whole.utime[i]);
    gap.heave_m.push_back(whole.heave_m[i]);
  }
  for (const auto& c : {compare_with_truth(gap, whole, {}), compare_with_truth(whole, gap, {})}) {
    EXPECT_NEAR(c.samples(), 8000, 4);
    EXPECT_LT(c.rmse_m(), 1e-6);
  }
}

TEST(HeaveAgainstTruth, RefusesSeriesThatDoNotMeet) {
  HeaveSeries late = series(100, 10, 0, 0);
  for (auto& utime : late.utime) utime += 100'000'000;
  EXPECT_THROW(compare_with_truth(late, series(100, 10, 0, 0), {}), UserError);
}

TEST(HeaveAgainstTruth, RefusesWhereNothingIsLeftToCompare) {
  const HeaveSeries heave = series(100, 10, 0, 0);
  HeaveSeries still = heave;
  still.moving.assign(still.utime.size(), false);
  EXPECT_THROW(compare_with_truth(heave, still, {}), UserError);
  EXPECT_THROW(compare_with_truth(heave, heave, {.high_pass_hz = 50}), UserError) << "nothing passes";
  EXPECT_NO_THROW(compare_with_truth(heave, heave, {.high_pass_hz = 49}));
}

}  // namespace
}  // namespace waverig::evaluation
