#include "estimator/sample_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr std::int64_t kInterval_us = 10'000;

class SampleGuardTest : public ::testing::Test {
 protected:
  // The i-th sample of a calm, noisy record.
  ImuSample sample(std::int64_t i) {
    ImuSample s;
    s.utime = i * kInterval_us;
    s.seq = i;
    s.f_B = Vector3d(noise_.gaussian(0.02), noise_.gaussian(0.02), -9.8 + noise_.gaussian(0.02));
    s.w_NB_B = Vector3d(noise_.gaussian(0.01), 0, 0);
    return s;
  }
  void feed(std::int64_t from, std::int64_t to) {
    for (std::int64_t i = from; i < to; ++i) ASSERT_TRUE(guard_.check(sample(i)).usable);
  }
  RandomStream noise_{1, "guard"};
  SampleGuard guard_;
};

TEST_F(SampleGuardTest, LetsGoodSamplesThroughWithTheirInterval) {
  EXPECT_EQ(guard_.check(sample(0)).dt_s, 0);
  for (std::int64_t i = 1; i < 500; ++i) {
    const GuardVerdict verdict = guard_.check(sample(i));
    ASSERT_TRUE(verdict.usable);
    ASSERT_EQ(verdict.flags, 0);
    ASSERT_DOUBLE_EQ(verdict.dt_s, 0.01);
  }
  EXPECT_NEAR(guard_.usual_interval_s(), 0.01, 1e-12);
}

TEST_F(SampleGuardTest, RefusesRepeatedAndOutOfOrderSamples) {
  feed(0, 100);
  EXPECT_FALSE(guard_.check(sample(99)).usable);
  EXPECT_FALSE(guard_.check(sample(50)).usable);
  EXPECT_TRUE(guard_.check(sample(50)).flags & flag::kRange);
  const GuardVerdict next = guard_.check(sample(100));
  EXPECT_TRUE(next.usable);
  EXPECT_DOUBLE_EQ(next.dt_s, 0.01);
}

TEST_F(SampleGuardTest, RefusesWhatIsNotFiniteOrNotPlausible) {
  feed(0, 100);
  ImuSample s = sample(100);
  s.f_B.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(guard_.check(s).usable);
  s = sample(101);
  s.w_NB_B.z() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(guard_.check(s).usable);
  s = sample(102);
  s.f_B.x() = 1e6;
  EXPECT_TRUE(guard_.check(s).flags & flag::kRange);
  EXPECT_TRUE(guard_.check(sample(103)).usable);
}

TEST_F(SampleGuardTest, TellsAGapAndItsLength) {
  feed(0, 100);
  const GuardVerdict verdict = guard_.check(sample(150));
  EXPECT_TRUE(verdict.usable);
  EXPECT_TRUE(verdict.flags & flag::kGap);
  EXPECT_DOUBLE_EQ(verdict.dt_s, 0.51);
  EXPECT_FALSE(guard_.check(sample(151)).flags & flag::kGap);
}

TEST_F(SampleGuardTest, LearnsTheIntervalWhateverTheFirstOneIs) {
  for (const std::int64_t late_us : {-5'500, 10'800'000}) {
    SampleGuard guard;
    int gaps = 0;
    for (std::int64_t i = 0; i < 500; ++i) {
      ImuSample s = sample(i);
      if (i > 0) s.utime += late_us;
      const GuardVerdict verdict = guard.check(s);
      ASSERT_TRUE(verdict.usable);
      if (i == 1) {
        EXPECT_EQ((verdict.flags & flag::kGap) != 0, late_us > 0);
      }
      if (i > 1) gaps += (verdict.flags & flag::kGap) != 0;
    }
    EXPECT_EQ(gaps, 0) << late_us;
    EXPECT_NEAR(guard.usual_interval_s(), 0.01, 1e-4) << late_us;
  }
}

TEST_F(SampleGuardTest, TakesToANewRateButNotToLostSamples) {
  feed(0, 500);
  std::int64_t i = 500;
  for (; i < 1500; i += 1 + (i % 3 == 0)) ASSERT_TRUE(guard_.check(sample(i)).usable);  // a third is lost
  EXPECT_NEAR(guard_.usual_interval_s(), 0.01, 1e-9);
  int gaps = 0;
  for (; i < 2500; i += 10) gaps += (guard_.check(sample(i)).flags & flag::kGap) != 0;
  EXPECT_LE(gaps, 10);
  EXPECT_NEAR(guard_.usual_interval_s(), 0.1, 1e-9);
  for (; i < 3500; ++i) ASSERT_FALSE(guard_.check(sample(i)).flags & flag::kGap);
  EXPECT_NEAR(guard_.usual_interval_s(), 0.01, 1e-3);
}

TEST_F(SampleGuardTest, ABadTimeStampCostsItsOwnSampleAlone) {
  feed(0, 100);
  for (const std::int64_t ahead_us : {70'000'000LL, 36'000'000'000LL, 1'700'000'000'000'000LL}) {
    SampleGuard guard = guard_;
    ImuSample s = sample(100);
    s.utime += ahead_us;
    const GuardVerdict verdict = guard.check(s);
    EXPECT_FALSE(verdict.usable);
    EXPECT_TRUE(verdict.flags & flag::kGap);
    const GuardVerdict next = guard.check(sample(101));
    EXPECT_TRUE(next.usable);
    EXPECT_DOUBLE_EQ(next.dt_s, 0.02);
    EXPECT_TRUE(guard.check(sample(102)).usable);
  }
}

TEST_F(SampleGuardTest, BelievesALongGapFromItsSecondSampleOn) {
  feed(0, 100);
  EXPECT_FALSE(guard_.check(sample(10000)).usable);
  EXPECT_FALSE(guard_.check(sample(50)).usable);  // a straggler says nothing for it
  const GuardVerdict verdict = guard_.check(sample(10001));
  EXPECT_TRUE(verdict.usable);
  EXPECT_TRUE(verdict.flags & flag::kGap);
  EXPECT_DOUBLE_EQ(verdict.dt_s, 99.02);
  feed(10002, 10100);
}

TEST_F(SampleGuardTest, UnusableSamplesAreNoGap) {
  feed(0, 100);
  for (std::int64_t i = 100; i < 10000; ++i) {
    ImuSample s = sample(i);
    s.f_B.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(guard_.check(s).flags, flag::kRange);
  }
  EXPECT_TRUE(guard_.check(sample(10000)).usable);
}

TEST_F(SampleGuardTest, RefusesTimesWhoseDifferencesWouldOverflow) {
  for (const std::int64_t utime :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    ImuSample s = sample(0);
    s.utime = utime;
    const GuardVerdict verdict = guard_.check(s);
    EXPECT_FALSE(verdict.usable);
    EXPECT_TRUE(verdict.flags & flag::kRange);
  }
  feed(0, 100);
}

TEST_F(SampleGuardTest, RefusesASpikeButNotAStep) {
  feed(0, 100);
  ImuSample s = sample(100);
  s.f_B.z() += 15;
  const GuardVerdict spike = guard_.check(s);
  EXPECT_FALSE(spike.usable);
  EXPECT_TRUE(spike.flags & flag::kSpike);
  EXPECT_TRUE(guard_.check(sample(101)).usable);
  int usable = 0;
  for (std::int64_t i = 102; i < 110; ++i) {
    s = sample(i);
    s.f_B.z() += 15;
    usable += guard_.check(s).usable;
  }
  EXPECT_EQ(usable, 6);  // the third of a row is believed
}

TEST_F(SampleGuardTest, RefusesAFlatLineUntilItMovesAgain) {
  feed(0, 100);
  ImuSample stuck = sample(100);
  int refused = 0;
  for (std::int64_t i = 100; i < 400; ++i) {
    stuck.utime = i * kInterval_us;
    const GuardVerdict verdict = guard_.check(stuck);
    refused += !verdict.usable;
    EXPECT_EQ(verdict.usable, !(verdict.flags & flag::kFlatLine));
  }
  EXPECT_EQ(refused, 200);  // one second is needed to tell
  EXPECT_TRUE(guard_.check(sample(400)).usable);
}

TEST_F(SampleGuardTest, FlagsSaturationAndKeepsTheFlagsOfTheSample) {
  SampleGuardSettings settings;
  settings.accel_limit_mps2 = 39;
  SampleGuard guard(settings);
  ImuSample s = sample(0);
  s.f_B.z() = -39;
  s.flags = flag::kUncalibrated;
  const GuardVerdict verdict = guard.check(s);
  EXPECT_TRUE(verdict.usable);
  EXPECT_EQ(verdict.flags, flag::kSaturation | flag::kUncalibrated);

  settings = {};
  settings.gyro_limit_radps = 3.4;
  SampleGuard of_gyro(settings);
  for (const double rate : {3.3, -3.4, 3.3, 3.4}) {
    s = sample(s.seq + 1);
    s.w_NB_B.y() = rate;
    EXPECT_EQ((of_gyro.check(s).flags & flag::kSaturation) != 0, std::abs(rate) == 3.4) << rate;
  }
}


// A bit that flips turns the frame over for good, if the attitude believes it.
TEST_F(SampleGuardTest, RefusesASpikeOfTheGyroscopeToo) {
  feed(0, 200);
  for (const double spike_radps : {4.0, -30.0}) {
    ImuSample s = sample(200);
    s.w_NB_B.y() = spike_radps;
    const GuardVerdict verdict = guard_.check(s);
    EXPECT_FALSE(verdict.usable);
    EXPECT_EQ(verdict.flags, flag::kSpike);
  }
  feed(201, 300);
}

TEST_F(SampleGuardTest, FindsNoGapsInASlowEvenRecord) {
  for (const std::int64_t interval_us : {312'500, 400'000, 781'250, 1'000'000}) {
    SampleGuard guard;
    for (int i = 0; i < 50; ++i) {
      ImuSample s = sample(i);
      s.utime = i * interval_us;
      const GuardVerdict verdict = guard.check(s);
      EXPECT_EQ(verdict.flags, 0) << interval_us << " us, sample " << i;
      EXPECT_EQ(verdict.anew, i == 0);
    }
  }
}

}  // namespace
}  // namespace waverig::estimator
