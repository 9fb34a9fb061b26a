// What repeats of one setting tell together.
#include "estimator/evaluation/cells.h"

#include <gtest/gtest.h>

#include <cmath>

namespace waverig::evaluation {
namespace {

RunResult repeat(int number) {
  RunResult run;
  run.run = std::to_string(number);
  run.method = "harmonic";
  run.period_s = 6;
  run.height_m = 1;
  run.repeat = number;
  return run;
}

double contribution(const CellResult& cell, std::string_view name) {
  for (const Contribution& c : cell.statistics.budget)
    if (c.name == name) return c.sigma_m;
  return estimator::kUnknown;
}

// Each run learns its frequency by itself; the calibration is that of them all.
TEST(Cells, OnlyWhatEachRunLearnsByItselfAveragesOut) {
  std::vector<RunResult> runs;
  for (int k = 0; k < 4; ++k) {
    RunResult run = repeat(k);
    for (int i = 0; i < 10; ++i) {
      estimator::Wave wave;
      wave.period_s = 6;
      wave.height_m = 1;
      wave.noise_sigma_m = 0;
      wave.frequency_sigma_m = 0.004;
      wave.calibration_sigma_m = 0.003;
      run.waves.push_back({wave, 1});
    }
    runs.push_back(run);
  }
  const CellResult cell = cells_of(runs).at(0);
  EXPECT_EQ(cell.statistics.waves, 40);
  EXPECT_NEAR(contribution(cell, "frequency"), 0.002, 1e-12);
  EXPECT_NEAR(contribution(cell, "calibration"), 0.003, 1e-12);
}

TEST(Cells, HeightsOfSeasScatterLessInTheMeanOfSeveral) {
  std::vector<RunResult> runs;
  for (int k = 0; k < 4; ++k) {
    RunResult run = repeat(k);
    JudgedSea sea;
    sea.sea.hm0_m = k % 2 == 0 ? 1.9 : 2.1;
    sea.sea.hm0_sigma_m = 0.1;
    sea.sea.hm0_systematic_sigma_m = 0;
    run.seas.push_back(sea);
    runs.push_back(run);
  }
  const CellResult cell = cells_of(runs).at(0);
  EXPECT_NEAR(cell.sea.sea.hm0_m, 2, 1e-12);
  EXPECT_NEAR(cell.sea.sea.hm0_sigma_m, 0.05, 1e-12);
}

// 0.1 m is 0.06 m in all records of the sensor and 0.08 m by chance, which four of them halve. Where the parts
// are not told, all of it may be the sensor's.
TEST(Cells, WhatTheSensorDoesWrongIsNotLessenedByRepeats) {
  for (const auto& [systematic_m, expected_m] :
       {std::pair{0.06, std::hypot(0.06, 0.04)}, {0.1, 0.1}, {0.0, 0.05}, {estimator::kUnknown, 0.1}}) {
    std::vector<RunResult> runs;
    for (int k = 0; k < 4; ++k) {
      RunResult run = repeat(k);
      JudgedSea sea;
      sea.sea.hm0_m = 2;
      sea.sea.hm0_sigma_m = 0.1;
      sea.sea.hm0_systematic_sigma_m = systematic_m;
      run.seas.push_back(sea);
      runs.push_back(run);
    }
    const estimator::SeaState pooled = cells_of(runs).at(0).sea.sea;
    EXPECT_NEAR(pooled.hm0_sigma_m, expected_m, 1e-12) << systematic_m;
    EXPECT_NEAR(pooled.hm0_systematic_sigma_m, std::isfinite(systematic_m) ? systematic_m : 0.1, 1e-12);
  }
}

TEST(Cells, DirectionsAreMeanAngles) {
  const auto mean_deg = [](std::vector<double> directions_deg) {
    std::vector<RunResult> runs;
    for (const double deg : directions_deg) {
      RunResult run = repeat(static_cast<int>(runs.size()));
      JudgedSea sea;
      sea.sea.mean_direction_rad = deg * kDegree;
      run.seas.push_back(sea);
      runs.push_back(run);
    }
    return cells_of(runs).at(0).sea.sea.mean_direction_rad / kDegree;
  };
  EXPECT_NEAR(mean_deg({350, 20}), 5, 1e-9);
  EXPECT_NEAR(mean_deg({170, 200, 185}), 185, 1e-9);
  EXPECT_TRUE(std::isnan(mean_deg({10, 190})));  // from both sides there is no mean
  EXPECT_TRUE(std::isnan(mean_deg({0, 90, 180, 270})));
}

}  // namespace
}  // namespace waverig::evaluation
