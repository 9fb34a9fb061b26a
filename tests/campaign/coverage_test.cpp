#include "rig/campaign/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace waverig::rig {
namespace {

// `waverig bench-estimators --rigs 300` gives 95 and 97 to 98 %; of 60 rigs two standard deviations are 6 %.
TEST(Coverage, OfTheExpandedIntervalAndClosureOfTheBudgetOverSixtyRigs) {
  const auto cells = coverage(1000, 60, {{.period_s = 4, .height_m = 1}}, 40, "harmonic");
  ASSERT_EQ(cells.size(), 1u);
  const Coverage& cell = cells.front();
  EXPECT_EQ(cell.rigs, 60);
  EXPECT_GE(cell.inside, 53);
  EXPECT_GT(cell.rms_error / cell.predicted, 0.7);
  EXPECT_LT(cell.rms_error / cell.predicted, 1.3);
  EXPECT_LT(std::abs(cell.mean_error), 3 * cell.predicted / std::sqrt(60.0));
}

}  // namespace
}  // namespace waverig::rig
