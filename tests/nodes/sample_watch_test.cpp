#include "rig/nodes/sample_watch.h"

#include <gtest/gtest.h>

#include <limits>

#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

class SampleWatchTest : public ::testing::Test {
 protected:
  // Samples of a calm, noisy record, every 10 ms, from one time to another.
  void feed(double from_s, double to_s) {
    for (auto utime = static_cast<std::int64_t>(1e6 * from_s); utime < static_cast<std::int64_t>(1e6 * to_s); utime += 10'000)
      watch_.add(sample(utime));
  }
  estimator::ImuSample sample(std::int64_t utime) {
    estimator::ImuSample s;
    s.utime = utime;
    s.f_B = Vector3d(noise_.gaussian(0.02), noise_.gaussian(0.02), -9.8 + noise_.gaussian(0.02));
    return s;
  }
  RandomStream noise_{1, "watch"};
  SampleWatch watch_;
};

TEST_F(SampleWatchTest, SaysNothingOfAGoodRecord) {
  feed(0, 60);
  EXPECT_EQ(watch_.samples(), 6000);
  EXPECT_EQ(watch_.left_out(), 0);
  EXPECT_EQ(watch_.words(), "");
}

TEST_F(SampleWatchTest, TellsAClockThatWasSetBackAndByHowMuch) {
  feed(0, 60);
  feed(47.66, 100);
  EXPECT_EQ(watch_.words(),
            "1234 of 11234 samples left out: 1234 of a time not after that of the sample before (from sample 6001, "
            "time 47660000: was the clock set back by 12.3 s?)");
}

TEST_F(SampleWatchTest, OfTwoClocksSetBackItNamesTheFirst) {
  feed(0, 60);
  feed(50, 70);
  feed(65, 80);
  EXPECT_NE(watch_.words().find("from sample 6001, time 50000000: was the clock set back by 10.0 s?"), std::string::npos)
      << watch_.words();
}

TEST_F(SampleWatchTest, TakesNoStragglersForAClock) {
  feed(0, 30);
  watch_.add(sample(29'990'000));
  watch_.add(sample(29'500'000));
  feed(30, 60);
  EXPECT_EQ(watch_.words(), "2 of 6002 samples left out: 2 of a time not after that of the sample before");
}

TEST_F(SampleWatchTest, CountsEachReasonByItself) {
  feed(0, 30);
  estimator::ImuSample bad = sample(30'000'000);
  bad.f_B.x() = std::numeric_limits<double>::quiet_NaN();
  watch_.add(bad);
  bad = sample(30'010'000);
  bad.f_B.z() += 50;
  watch_.add(bad);
  feed(30.02, 40);
  watch_.add(sample(3'000'000'000));  // a bad time stamp
  feed(45.01, 50);                    // after five seconds of silence
  for (int i = 0; i < 150; ++i) {
    bad = sample(50'000'000 + i * 10'000);
    bad.f_B = Vector3d(0, 0, -9.8);
    watch_.add(bad);
  }
  EXPECT_EQ(watch_.words(),
            "53 of 4650 samples left out: 1 of a time a minute or more ahead of all before, 1 not finite or beyond "
            "what is plausible, 1 spike, 50 of a reading that stands still; 2 gaps in the times, 5.03 s in all");
}

TEST_F(SampleWatchTest, BeginsItsTimesAnewWithARecord) {
  feed(100, 110);
  watch_.begin_record();
  feed(0, 10);
  EXPECT_EQ(watch_.words(), "");
  EXPECT_EQ(watch_.samples(), 2000);
}

}  // namespace
}  // namespace waverig::rig
