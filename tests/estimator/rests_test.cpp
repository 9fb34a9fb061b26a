// Where a body rests within a record: found in runs and rests, and nowhere in a sea.
#include "estimator/heave/rests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::Pace;
using estimator::Rests;

constexpr double kInterval_s = 0.5;
constexpr double kAccelNoise_m2ps3 = 6e-6;

// Speed at nodes, as a sensor tells it that is off by a steady acceleration.
Eigen::VectorXd speed_of(const SeaRecord& record, double rate_Hz, std::uint64_t seed) {
  RandomStream noise(seed, "speed");
  const auto every = static_cast<std::size_t>(rate_Hz * kInterval_s);
  Eigen::VectorXd speed(static_cast<Eigen::Index>((record.heave_rate_mps.size() - 1) / every + 1));
  double drift_mps = 0;
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    speed[k] = record.heave_rate_mps[static_cast<std::size_t>(k) * every] + drift_mps + 0.02 * kInterval_s * static_cast<double>(k);
    drift_mps += noise.gaussian(std::sqrt(kAccelNoise_m2ps3 * kInterval_s));
  }
  return speed;
}

// Of the record's own motion, its rests left out.
Pace pace_of(double period_s, double hm0_m) {
  return {2 * std::numbers::pi / period_s * hm0_m / 4, period_s};
}

TEST(Rests, AreFoundBetweenRunsWithWhatLiesBetweenThemAndTheSea) {
  struct Runs {
    double tp_s, hm0_m, lasts_s, rest_s;
  };
  for (const Runs& runs : {Runs{3, 0.3, 120, 30}, {6, 1, 60, 20}, {12, 1, 300, 60}, {16, 0.2, 300, 90}}) {
    const SeaCase sea{.tp_s = runs.tp_s, .hm0_m = runs.hm0_m, .duration_s = runs.lasts_s};
    const auto [record, begins_s] = runs_and_rests(sea, sea, runs.rest_s, 3, 1, runs.hm0_m / 4);
    const double period_s = runs.tp_s / 1.3;
    const Rests rests = find_rests(speed_of(record, sea.rate_Hz, 1), kInterval_s, pace_of(period_s, runs.hm0_m), kAccelNoise_m2ps3);
    ASSERT_TRUE(rests.any());
    for (std::size_t k = 0; k < rests.still.size(); ++k) {
      const double t_s = static_cast<double>(k) * kInterval_s + 1;
      double from_rest_s = begins_s[0] - t_s;   // into a rest positive
      for (std::size_t i = 0; i < begins_s.size(); ++i) {
        const double stops_s = begins_s[i] + runs.lasts_s, next_s = i + 1 < begins_s.size() ? begins_s[i + 1] : INFINITY;
        if (t_s >= begins_s[i]) from_rest_s = std::max(begins_s[i] - t_s, std::min(t_s - stops_s, next_s - t_s));
      }
      const std::string where = std::to_string(runs.tp_s) + " s at " + std::to_string(t_s) + " s, " + std::to_string(from_rest_s);
      if (from_rest_s < -0.5) { EXPECT_FALSE(rests.still[k]) << where; }
      if (from_rest_s < -3.7 * period_s) { EXPECT_FALSE(rests.between[k]) << where; }
      if (std::abs(from_rest_s) < 0.5) { EXPECT_TRUE(rests.between[k]) << where; }
      if (from_rest_s > 0.8 * period_s) { EXPECT_TRUE(rests.still[k]) << where; }
    }
  }
}

// Neither in the lowest groups of hours of sea, nor where it comes up out of a lower one or dies away.
TEST(Rests, AreNotFoundInASea) {
  for (const SeaCase& sea : {SeaCase{.tp_s = 3, .hm0_m = 0.5, .duration_s = 7200, .rate_Hz = 10},
                             {.tp_s = 8, .hm0_m = 0.5, .duration_s = 7200, .rate_Hz = 10},
                             {.tp_s = 16, .hm0_m = 4, .duration_s = 7200, .rate_Hz = 10}})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Rests rests = find_rests(speed_of(sea_record(sea, seed), sea.rate_Hz, seed), kInterval_s, pace_of(sea.tp_s / 1.3, sea.hm0_m), kAccelNoise_m2ps3);
      EXPECT_FALSE(rests.any()) << sea.tp_s << " s, seed " << seed;
    }
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SeaRecord fading = changing_record({.tp_s = 8, .hm0_m = 3}, {.tp_s = 8, .hm0_m = 0.5, .duration_s = 900}, 300, 60, seed);
    EXPECT_FALSE(find_rests(speed_of(fading, 100, seed), kInterval_s, pace_of(6, 1.8), kAccelNoise_m2ps3).any()) << seed;
  }
}

// What comes up over minutes is a sea all the time.
TEST(Rests, EndWithinThreePeriods) {
  const SeaRecord rising = changing_record({.tp_s = 8, .hm0_m = 1e-3}, {.tp_s = 8, .hm0_m = 2, .duration_s = 900}, 60, 600, 1);
  const Rests rests = find_rests(speed_of(rising, 100, 1), kInterval_s, pace_of(6, 2), kAccelNoise_m2ps3);
  const auto last = static_cast<std::size_t>(std::find(rests.still.rbegin(), rests.still.rend(), true).base() - rests.still.begin()) - 1;
  EXPECT_GT(static_cast<double>(last) * kInterval_s, 50);
  for (std::size_t k = last + 1; k < rests.between.size(); ++k) EXPECT_EQ(rests.between[k], k <= last + 36) << k - last;
}

// A record that holds less than a period, or nothing but a rest, or a sea of which nothing is known.
TEST(Rests, TakeRecordsOfAnyLength) {
  for (const Eigen::Index n : {0, 1, 2, 12, 13, 500}) {
    const Eigen::VectorXd speed = Eigen::VectorXd::Zero(n);
    const Rests rests = find_rests(speed, kInterval_s, pace_of(6, 1), kAccelNoise_m2ps3);
    EXPECT_EQ(rests.still.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(rests.any(), n >= 13) << n;
  }
}

}  // namespace
}  // namespace waverig::testing
