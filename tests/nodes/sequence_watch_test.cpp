#include "rig/nodes/sequence_watch.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace waverig::rig {
namespace {

TEST(SequenceWatch, CountsWhatIsMissingBetweenTwoMessages) {
  SequenceWatch watch;
  EXPECT_EQ(watch.missing_before(7), 0) << "what went before the first message is not missing";
  EXPECT_EQ(watch.missing_before(8), 0);
  EXPECT_EQ(watch.missing_before(12), 3);
  EXPECT_EQ(watch.missing(), 3);
  EXPECT_FALSE(watch.anew());
}

TEST(SequenceWatch, TakesALowerNumberForANewCountFromZero) {
  SequenceWatch watch;
  watch.missing_before(500);
  EXPECT_EQ(watch.missing_before(0), 0);
  EXPECT_TRUE(watch.anew());
  watch.missing_before(1);
  EXPECT_FALSE(watch.anew());
  EXPECT_EQ(watch.missing_before(1), 1) << "the new count's 0 was lost";
  EXPECT_TRUE(watch.anew());
}

TEST(SequenceWatch, IsNotHarmedByNonsense) {
  SequenceWatch watch;
  watch.missing_before(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(watch.missing(), 0);
  EXPECT_EQ(watch.missing_before(std::numeric_limits<std::int64_t>::max()),
            std::numeric_limits<std::int64_t>::max() - 1);
  EXPECT_EQ(watch.missing_before(-5), 0);
}

}  // namespace
}  // namespace waverig::rig
