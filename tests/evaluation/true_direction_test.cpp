#include "estimator/evaluation/true_direction.h"

#include <gtest/gtest.h>

#include <numbers>

namespace waverig::evaluation {
namespace {

struct Wave {
  double period_s, height_m, from_rad, horizontal = 1;  // horizontal over vertical motion
};

// Deep water: at the crest the water moves the way the wave goes.
TruthSeries truth_of(const std::vector<Wave>& waves, double duration_s) {
  TruthSeries truth;
  for (std::int64_t i = 0; static_cast<double>(i) * 0.02 <= duration_s; ++i) {
    const double t_s = static_cast<double>(i) * 0.02;
    double heave_m = 0, rate_mps = 0;
    Eigen::Vector2d horizontal_m = Eigen::Vector2d::Zero();
    for (const Wave& wave : waves) {
      const double w = 2 * std::numbers::pi / wave.period_s, a = wave.height_m / 2;
      heave_m += a * std::cos(w * t_s);
      rate_mps -= a * w * std::sin(w * t_s);
      const Eigen::Vector2d towards(-std::cos(wave.from_rad), -std::sin(wave.from_rad));
      horizontal_m += wave.horizontal * a * std::sin(w * t_s) * towards;
    }
    truth.add(i * 20000, heave_m, rate_mps, horizontal_m);
  }
  return truth;
}

constexpr std::int64_t kEnd = 600 * 1000000LL;

TEST(TrueDirection, OfARegularWaveIsWhereItComesFrom) {
  for (const double from_deg : {0.0, 70.0, 160.0, 250.0, 340.0}) {
    const TrueDirection d = true_direction(truth_of({{8, 1, from_deg * kDegree}}, 600), 0, kEnd);
    EXPECT_NEAR(std::remainder(d.mean_direction_rad - from_deg * kDegree, 2 * std::numbers::pi), 0, 1e-6);
    EXPECT_GE(d.mean_direction_rad, 0);
    EXPECT_LT(d.spread_rad, 0.2 * kDegree);
    EXPECT_NEAR(d.check_factor, 1, 1e-4);
  }
}

// Two waves of one energy, 60 degrees apart: r1 = cos 30, spread sqrt(2 (1 - r1)).
TEST(TrueDirection, OfTwoSeasLiesBetweenThemAndIsSpread) {
  const TrueDirection d =
      true_direction(truth_of({{6, 1, 100 * kDegree}, {11, 1, 160 * kDegree}}, 600), 0, kEnd);
  EXPECT_NEAR(d.mean_direction_rad, 130 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(d.spread_rad, std::sqrt(2 * (1 - std::cos(30 * kDegree))), 0.1 * kDegree);
}

TEST(TrueDirection, CheckFactorIsHorizontalOverVertical) {
  EXPECT_NEAR(true_direction(truth_of({{8, 1, 2, 1.3}}, 600), 0, kEnd).check_factor, 1.3, 1e-4);
}

TEST(TrueDirection, IsUnknownWithoutHorizontalMotionAndOutsideOfTheTruth) {
  EXPECT_TRUE(std::isnan(true_direction(truth_of({{8, 1, 2, 0}}, 600), 0, kEnd).mean_direction_rad));
  EXPECT_TRUE(std::isnan(true_direction(truth_of({{8, 1, 2}}, 600), 0, 2 * kEnd).mean_direction_rad));
  EXPECT_TRUE(std::isnan(true_direction(truth_of({{8, 1, 2}}, 600), 0, 5 * 1000000LL).mean_direction_rad));
  EXPECT_TRUE(std::isnan(true_direction(TruthSeries(), 0, kEnd).mean_direction_rad));
}

}  // namespace
}  // namespace waverig::evaluation
