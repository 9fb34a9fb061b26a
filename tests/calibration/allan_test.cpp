#include "estimator/calibration/allan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kInterval = 0.01;

std::vector<double> white(std::size_t n, double sigma, std::uint64_t seed) {
  RandomStream random(seed, "white");
  std::vector<double> record(n);
  for (double& x : record) x = random.gaussian(sigma);
  return record;
}

TEST(Allan, WhiteNoiseFallsWithTheRootOfTau) {
  const auto points = allan_deviation(white(400000, 0.5, 1), kInterval);
  for (const AllanPoint& p : points) {
    if (p.degrees < 400) break;  // beyond, the record is too short to say it within the tolerance
    EXPECT_NEAR(p.deviation / (0.5 * std::sqrt(kInterval / p.tau_s)), 1, 4 / std::sqrt(p.degrees)) << p.tau_s;
  }
  EXPECT_DOUBLE_EQ(points.front().tau_s, kInterval);
  EXPECT_LE(points.back().tau_s, 1000);
}

TEST(Allan, ARampShowsItsSlope) {
  std::vector<double> ramp(10000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 3 * kInterval * static_cast<double>(i);
  for (const AllanPoint& p : allan_deviation(ramp, kInterval))
    EXPECT_NEAR(p.deviation, 3 * p.tau_s / std::sqrt(2.0), 1e-6 * p.deviation);
}

TEST(Allan, FitFindsWhiteNoiseAndRateRandomWalkTogether) {
  constexpr double kDensity = 0.003, kWalk = 0.0004;  // per sqrt(Hz), one-sided; per s sqrt(s)
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto record = white(600000, kDensity / std::sqrt(2 * kInterval), seed);
    RandomStream random(seed, "walk");
    double level = 0;
    for (double& x : record) x += level += random.gaussian(kWalk * std::sqrt(kInterval));
    const AllanTerms terms = fit_allan(allan_deviation(record, kInterval));
    EXPECT_NEAR(terms.one_sided_density() / kDensity, 1, 0.03);
    EXPECT_NEAR(terms.rate_random_walk / kWalk, 1, 0.35);
    EXPECT_LT(terms.quantisation, 0.05 * kDensity);
  }
}

TEST(Allan, FitTellsQuantisationFromWhiteNoise) {
  // Differences of a rounded integral, as a charge-balance converter counts: variance q^2/6, all at high
  // frequency.
  constexpr double kQuantum = 1e-3;
  RandomStream random(2, "remainder");
  std::vector<double> record(200000);
  double remainder = 0;
  for (double& x : record) {
    const double next = random.uniform(0, kQuantum);
    x = (next - remainder) / kInterval;
    remainder = next;
  }
  const AllanTerms terms = fit_allan(allan_deviation(record, kInterval));
  EXPECT_NEAR(terms.quantisation / (kQuantum / std::sqrt(12.0)), 1, 0.02);
  EXPECT_LT(terms.random_walk, 0.05 * kQuantum);
}

TEST(Allan, TooShortARecordGivesNoTerms) {
  const auto points = allan_deviation(white(6, 1, 1), kInterval);
  const AllanTerms terms = fit_allan(points);
  EXPECT_EQ(terms.random_walk, 0);
  EXPECT_TRUE(allan_deviation({}, kInterval).empty());
}

}  // namespace
}  // namespace waverig::estimator
