#include "render/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "motion/kinematics/random.h"

namespace waverig::render {
namespace {

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> out;
  for (const Tick& t : ticks.major) out.push_back(t.label);
  return out;
}

TEST(LinearTicks, AreRoundNumbers) {
  EXPECT_EQ(labels(linear_ticks(0, 10, 6)), (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels(linear_ticks(-0.3, 0.3, 4)), (std::vector<std::string>{"\u22120.2", "0.0", "0.2"}));
}

TEST(LinearTicks, HoldTheirPropertiesOnAnyInterval) {
  RandomStream random(3, "ticks");
  for (int i = 0; i < 5000; ++i) {
    const double low = (random.uniform() - 0.5) * std::pow(10, random.uniform(-8, 8));
    const double range = std::max(std::pow(10, random.uniform(-6, 8)), 1e-9 * std::abs(low));
    const int most = 3 + static_cast<int>(random.uniform(0, 10));
    const Ticks ticks = linear_ticks(low, low + range, most);
    ASSERT_LE(static_cast<int>(ticks.major.size()), most) << low << " " << range;
    ASSERT_GE(ticks.major.size(), 1U) << low << " " << range << " " << most;
    std::set<std::string> seen;
    for (std::size_t k = 0; k < ticks.major.size(); ++k) {
      ASSERT_GE(ticks.major[k].value, low - 1e-6 * range);
      ASSERT_LE(ticks.major[k].value, low + range * (1 + 1e-6));
      ASSERT_TRUE(seen.insert(ticks.major[k].label).second) << "two ticks read " << ticks.major[k].label;
      if (k >= 2) {
        const double a = ticks.major[k].value - ticks.major[k - 1].value,
                     b = ticks.major[k - 1].value - ticks.major[k - 2].value;
        ASSERT_NEAR(a, b, 1e-6 * range);
      }
    }
  }
}

TEST(LinearTicks, MoveLongCommonPartsToTheAxisLabel) {
  const Ticks small = linear_ticks(0, 4e-6, 5);
  EXPECT_EQ(small.suffix, "\u00D710\u207B\u2076");
  EXPECT_EQ(small.major.back().label, "4");
  const Ticks offset = linear_ticks(1.7e9, 1.7e9 + 10, 6);
  EXPECT_NE(offset.suffix.find("1700000000"), std::string::npos);
  EXPECT_LE(offset.major.back().label.size(), 4U);
}

TEST(LinearTicks, WriteNoNegativeZero) {
  for (const Tick& t : linear_ticks(-1e-3, 1e-3, 5).major) EXPECT_NE(t.label, "\u22120.0");
  EXPECT_EQ(number_text(-0.0001, 2), "0.00");
}

TEST(LogTicks, StandOnDecades) {
  EXPECT_EQ(labels(log_ticks(0.01, 100, 8)), (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(labels(log_ticks(1e-9, 1e-6, 8)).front(), "10\u207B\u2079");
}

TEST(LogTicks, KeepToOneNotationOnAnAxis) {
  EXPECT_EQ(labels(log_ticks(1e-5, 10, 8)).back(), "10\u00B9");
  EXPECT_EQ(labels(log_ticks(1e-5, 10, 8)).front(), "10\u207B\u2075");
}

TEST(NumberText, KeepsTheDigitsThatCount) {
  EXPECT_EQ(significant_text(1.46, 2), "1.5");
  EXPECT_EQ(significant_text(0.0413, 2), "0.041");
  EXPECT_EQ(significant_text(123.4, 2), "123");
  EXPECT_EQ(significant_text(-0.5, 2), "\u22120.50");
  EXPECT_EQ(significant_text(0, 2), "0");
}

TEST(LogTicks, FallBackToOneTwoFiveWithinADecade) {
  EXPECT_EQ(labels(log_ticks(0.3, 15, 6)), (std::vector<std::string>{"0.5", "1", "2", "5", "10"}));
  EXPECT_EQ(labels(log_ticks(0.3, 15, 4)), (std::vector<std::string>{"1", "10"})) << "no room for more";
  EXPECT_EQ(labels(log_ticks(0.9, 6, 6)), (std::vector<std::string>{"1", "2", "5"}));
}

TEST(LogTicks, ThinOutManyDecades) {
  const Ticks ticks = log_ticks(1e-30, 1e30, 6);
  EXPECT_LE(ticks.major.size(), 7U);
  EXPECT_GE(ticks.major.size(), 3U);
}

TEST(SignedLogTicks, StandOnBothSidesOfZero) {
  EXPECT_EQ(labels(signed_log_ticks(-30, 30, 1, 12)),
            (std::vector<std::string>{"\u221220", "\u221210", "\u22125", "\u22122", "\u22121", "0", "1", "2", "5", "10", "20"}));
  EXPECT_EQ(labels(signed_log_ticks(-30, 30, 1, 5)), (std::vector<std::string>{"\u221210", "\u22121", "0", "1", "10"}));
  EXPECT_LE(signed_log_ticks(-1e9, 1e9, 1e-9, 5).major.size(), 5U);
  EXPECT_EQ(labels(signed_log_ticks(-0.5, 0.5, 1, 5)), labels(linear_ticks(-0.5, 0.5, 5)));
}

TEST(TimeTicks, StandOnRoundTimesOfDay) {
  const double midnight = 1120176000;  // 2005-07-01 00:00 UTC
  const Ticks hours = time_ticks(midnight, midnight + 86400, 6);
  EXPECT_EQ(hours.suffix, "2005-07-01 UTC");
  EXPECT_EQ(labels(hours), (std::vector<std::string>{"00:00", "06:00", "12:00", "18:00", "00:00"}));
  const Ticks seconds = time_ticks(midnight + 30, midnight + 75, 6);
  EXPECT_EQ(seconds.major.front().label, "00:00:30");
  const Ticks fine = time_ticks(midnight, midnight + 0.5, 6);
  EXPECT_EQ(fine.major[1].label, "00:00:00.1");
}

// The axis label names the first day alone.
TEST(TimeTicks, NameEachFurtherDayAtItsMidnight) {
  const double noon = 1120176000 + 43200;  // 2005-07-01 12:00 UTC
  const Ticks two_days = time_ticks(noon, noon + 129600, 8);
  EXPECT_EQ(two_days.suffix, "2005-07-01 UTC");
  EXPECT_EQ(labels(two_days), (std::vector<std::string>{"12:00", "18:00", "00:00\n07-02", "06:00", "12:00", "18:00",
                                                        "00:00\n07-03"}));
}

TEST(NiceStep, IsTheSmallestThatFits) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(11, 5), 5);
  EXPECT_DOUBLE_EQ(nice_step(0.7, 7), 0.1);
}

}  // namespace
}  // namespace waverig::render
