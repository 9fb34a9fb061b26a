#include "motion/kinematics/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace waverig {
namespace {

// Four standard deviations of a count of rare events.
double four_sigma(double expected) { return 4 * std::sqrt(expected); }

TEST(RandomStream, GaussianHasTheNormalDistributionFromTailToTail) {
  RandomStream random(1, "gaussian");
  constexpr int kSamples = 2'000'000;
  constexpr int kBins = 20;  // half a standard deviation each, from -5 to 5
  std::array<double, kBins> counts{};
  double beyond_low = 0, beyond_high = 0, fourth = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = random.gaussian();
    if (x < -3.5) ++beyond_low;
    if (x > 3.5) ++beyond_high;
    if (std::abs(x) < 5) ++counts[static_cast<std::size_t>(std::floor(2 * x + 10))];
    fourth += x * x * x * x / kSamples;
  }
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  for (int i = 0; i < kBins; ++i) {
    const double expected = kSamples * (below(0.5 * (i + 1) - 5) - below(0.5 * i - 5));
    EXPECT_NEAR(counts[static_cast<std::size_t>(i)], expected, four_sigma(expected) + 1) << i;
  }
  const double tail = kSamples * below(-3.5);
  EXPECT_NEAR(beyond_low, tail, four_sigma(tail));
  EXPECT_NEAR(beyond_high, tail, four_sigma(tail));
  EXPECT_NEAR(fourth, 3, 4 * std::sqrt(96.0 / kSamples));
}

TEST(RandomStream, NeighboursAndStreamsOfOtherNamesAreIndependent) {
  RandomStream a(1, "a"), b(1, "b"), c(2, "a");
  constexpr int kSamples = 200'000;
  double ab = 0, ac = 0, lag = 0, last = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = a.gaussian();
    ab += x * b.gaussian();
    ac += x * c.gaussian();
    lag += x * last;
    last = x;
  }
  for (const double sum : {ab, ac, lag}) EXPECT_NEAR(sum / kSamples, 0, 4 / std::sqrt(1.0 * kSamples));
}

}  // namespace
}  // namespace waverig
