#include "estimator/evaluation/height_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::evaluation {
namespace {

JudgedWave wave(double height_m, double true_height_m) {
  JudgedWave w;
  w.wave.height_m = height_m;
  w.wave.period_s = 6;
  w.true_height_m = true_height_m;
  return w;
}

double contribution(const HeightStatistics& s, const std::string& name) {
  for (const Contribution& c : s.budget)
    if (c.name == name) return c.sigma_m;
  return estimator::kUnknown;
}

TEST(HeightStatistics, FollowTheirDefinitions) {
  HeightAccumulator a;
  for (const double h : {0.59, 0.61, 0.63}) a.add(wave(h, 0.60));
  a.close_record();
  const HeightStatistics s = a.statistics(0.62, 0.002);
  EXPECT_EQ(s.waves, 3);
  EXPECT_NEAR(s.mean_height_m, 0.61, 1e-12);
  EXPECT_NEAR(s.error_rate_percent, 100 * 0.01 / 0.62, 1e-9);
  EXPECT_NEAR(s.std_m, 0.02, 1e-12);
  EXPECT_NEAR(s.rmse_m, std::sqrt((0.0001 + 0.0001 + 0.0009) / 3), 1e-12);
  EXPECT_NEAR(s.mean_error_percent, 100 * 0.01 / 0.60, 1e-9);
  EXPECT_EQ(s.bound_std_m, 0.002);
  EXPECT_EQ(s.mean_period_s, 6);
}

// The published cells: error rates of REFERENCE section 2 follow from their means, to the digit printed.
TEST(HeightStatistics, ErrorRateReproducesThePublishedTable) {
  EXPECT_NEAR(error_rate_percent(60.86, 60), 1.43, 0.006);
  EXPECT_NEAR(error_rate_percent(78.44, 80), 1.95, 0.006);
  EXPECT_NEAR(error_rate_percent(97.30, 100), 2.70, 0.006);
  EXPECT_NEAR(error_rate_percent(67.19, 60), 11.98, 0.006);
  EXPECT_NEAR(error_rate_percent(78.28, 80), 2.15, 0.006);
  EXPECT_NEAR(error_rate_percent(100.80, 100), 0.80, 0.006);
}

TEST(HeightStatistics, NoiseIsNotCountedTwice) {
  HeightAccumulator a;
  for (int i = 0; i < 100; ++i) {
    JudgedWave w = wave(i % 2 == 0 ? 0.97 : 1.03, 1);
    w.wave.noise_sigma_m = 0.018;
    w.wave.calibration_sigma_m = 0.001;
    w.wave.tilt_sigma_m = 0.002;
    a.add(w);
  }
  a.close_record();
  const HeightStatistics s = a.statistics(1, 0.018);
  EXPECT_NEAR(contribution(s, "noise"), 0.0018, 1e-12);
  EXPECT_NEAR(std::hypot(contribution(s, "noise"), contribution(s, "scatter")), s.std_m / 10, 1e-12);
  EXPECT_NEAR(s.expanded_uncertainty_m, 2 * std::sqrt(s.std_m * s.std_m / 100 + 1e-6 + 4e-6), 1e-12);
}

TEST(HeightStatistics, ScatterBelowTheStatedNoiseAddsNothing) {
  HeightAccumulator a;
  for (int i = 0; i < 4; ++i) {
    JudgedWave w = wave(1, 1);
    w.wave.noise_sigma_m = 0.01;
    a.add(w);
  }
  const HeightStatistics s = a.statistics(1, 0.01);
  EXPECT_EQ(contribution(s, "scatter"), 0);
  EXPECT_NEAR(s.expanded_uncertainty_m, 0.01, 1e-12);
}

TEST(HeightStatistics, OnlyFrequencyAveragesOverRecords) {
  HeightAccumulator a;
  for (int record = 0; record < 4; ++record) {
    for (int i = 0; i < 10; ++i) {
      JudgedWave w = wave(1, 1);
      w.wave.frequency_sigma_m = 0.004;
      w.wave.calibration_sigma_m = 0.003;
      w.wave.noise_sigma_m = 0;
      a.add(w);
    }
    a.close_record();
  }
  const HeightStatistics s = a.statistics(1, 0);
  EXPECT_NEAR(contribution(s, "frequency"), 0.002, 1e-12);
  EXPECT_NEAR(contribution(s, "calibration"), 0.003, 1e-12);
}

// Heights that are all a tenth too low scatter by nothing: nobody may conclude from it that they are right.
TEST(HeightStatistics, OfAMethodThatStatesNothingTheUncertaintyIsUnknown) {
  HeightAccumulator a;
  for (const double h : {0.9, 1.0, 1.1}) a.add(wave(h, 1));
  const HeightStatistics s = a.statistics(1, estimator::kUnknown);
  ASSERT_EQ(s.budget.size(), 1u);
  EXPECT_EQ(s.budget[0].type, 'A');
  EXPECT_NEAR(s.budget[0].sigma_m, 0.1 / std::sqrt(3), 1e-12);
  EXPECT_TRUE(std::isnan(s.expanded_uncertainty_m));
}

TEST(HeightStatistics, SayWhenThereAreTooFewWaves) {
  HeightAccumulator none;
  EXPECT_EQ(none.statistics(1, 1).flags, flag::kTooFewWaves);
  EXPECT_TRUE(std::isnan(none.statistics(1, 1).mean_height_m));
  HeightAccumulator one;
  one.add(wave(1, 1));
  EXPECT_EQ(one.statistics(1, 1).flags, flag::kTooFewWaves);
  EXPECT_TRUE(std::isnan(one.statistics(1, 1).std_m));
}

// 2000 simulated rigs, each with its own scale-factor error, tilt error, frequency error per record and noise
// per wave: the expanded interval holds the true mean in 95.4 % of them.
TEST(HeightStatistics, ExpandedIntervalCoversTheTrueMean) {
  const double noise = 0.006, calibration = 0.0012, tilt = 0.0007, frequency = 0.001;
  int inside = 0;
  const int rigs = 2000;
  for (int rig = 0; rig < rigs; ++rig) {
    RandomStream random(static_cast<std::uint64_t>(rig), "coverage");
    const double common = random.gaussian(calibration) + random.gaussian(tilt);
    HeightAccumulator a;
    for (int record = 0; record < 3; ++record) {
      const double of_record = random.gaussian(frequency);
      for (int i = 0; i < 25; ++i) {
        JudgedWave w = wave(1 + common + of_record + random.gaussian(noise), 1);
        w.wave.noise_sigma_m = noise;
        w.wave.calibration_sigma_m = calibration;
        w.wave.tilt_sigma_m = tilt;
        w.wave.frequency_sigma_m = frequency;
        a.add(w);
      }
      a.close_record();
    }
    const HeightStatistics s = a.statistics(1, estimator::kUnknown);
    inside += std::abs(s.mean_height_m - s.mean_true_height_m) <= s.expanded_uncertainty_m ? 1 : 0;
  }
  EXPECT_GT(inside, 0.945 * rigs);
  EXPECT_LT(inside, 0.97 * rigs);
}

}  // namespace
}  // namespace waverig::evaluation
