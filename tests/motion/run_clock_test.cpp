#include "motion/run_clock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace waverig::motion {
namespace {

TEST(RunClock, RunsWithTimeUntilHeld) {
  RunClock clock;
  EXPECT_EQ(clock.read(3.5).profile_s, 3.5);
  EXPECT_EQ(clock.read(3.5).speed, 1);
}

TEST(RunClock, LosesHalfAnEasingOnEachSideAndTheTimeBetween) {
  RunClock clock;
  clock.hold(10, 4);
  EXPECT_EQ(clock.state(), RunClock::State::kSlowing);
  EXPECT_NEAR(clock.read(14).profile_s, 12, 1e-12);
  EXPECT_EQ(clock.state(), RunClock::State::kHeld);
  EXPECT_NEAR(clock.read(100).profile_s, 12, 1e-12);
  clock.resume(100, 4);
  EXPECT_NEAR(clock.read(104).profile_s, 14, 1e-12);
  EXPECT_EQ(clock.state(), RunClock::State::kRunning);
  EXPECT_NEAR(clock.read(110).profile_s, 20, 1e-12);
}

TEST(RunClock, SpeedIsTheDerivativeOfProfileTimeAndItsDerivativesFollow) {
  RunClock clock;
  clock.hold(10, 4);
  const double h = 1e-5;
  for (double t = 10.1; t < 13.9; t += 0.2) {
    const auto a = clock.read(t - h), m = clock.read(t), b = clock.read(t + h);
    EXPECT_NEAR((b.profile_s - a.profile_s) / (2 * h), m.speed, 1e-8);
    EXPECT_NEAR((b.speed - a.speed) / (2 * h), m.speed_1ps, 1e-8);
    EXPECT_NEAR((b.speed_1ps - a.speed_1ps) / (2 * h), m.speed_1ps2, 1e-8);
  }
}

TEST(RunClock, IgnoresAHoldThatIsNotPossible) {
  RunClock clock;
  clock.resume(1, 1);
  EXPECT_EQ(clock.state(), RunClock::State::kRunning);
  clock.hold(2, 4);
  clock.hold(3, 1);
  EXPECT_NEAR(clock.read(6).profile_s, 4, 1e-12);
}

TEST(RunClock, EasingOutOfTheSteadyPartKeepsTheLimits) {
  const RotationProfile profile({.period_s = 3});
  const AxisLimits limits{.rate_radps = 2.2, .accel_radps2 = 1, .jerk_radps3 = 1};
  const double at_s = profile.steady_begin_s() + 20;
  const auto ease_s = ease_s_within(limits, profile, at_s, false);
  ASSERT_TRUE(ease_s);
  RunClock clock;
  clock.hold(at_s, *ease_s);
  for (double t = at_s; t < at_s + *ease_s; t += 0.001) {
    const ProfilePoint p = eased(profile, clock.read(t));
    ASSERT_FALSE(exceeds(limits, p.rate_radps, p.accel_radps2, p.jerk_radps3));
  }
  EXPECT_GT(*ease_s, 1);  // and the limits do bind
}

// In a ramp, where the profile's own acceleration and jerk take part in the easing.
TEST(RunClock, EasedAccelerationAndJerkAreDerivativesOfTheEasedRate) {
  const RotationProfile profile({.period_s = 4, .ramp_periods = 2, .rest_before_s = 0});
  const double h = 1e-5;
  for (const bool resuming : {false, true}) {
    RunClock clock;
    clock.hold(1, 2);
    if (resuming) {
      clock.read(5);
      clock.resume(5, 3);
    }
    const double begin_s = resuming ? 5 : 1, end_s = resuming ? 8 : 3;
    for (double t = begin_s + 0.1; t < end_s - 0.05; t += 0.1) {
      const ProfilePoint a = eased(profile, clock.read(t - h)), p = eased(profile, clock.read(t)),
                         b = eased(profile, clock.read(t + h));
      EXPECT_NEAR((b.angle_rad - a.angle_rad) / (2 * h), p.rate_radps, 1e-8) << t;
      EXPECT_NEAR((b.rate_radps - a.rate_radps) / (2 * h), p.accel_radps2, 1e-8) << t;
      EXPECT_NEAR((b.accel_radps2 - a.accel_radps2) / (2 * h), p.jerk_radps3, 1e-8) << t;
    }
  }
}

// Slowing and resuming take the same accelerations where the rate stands, not where it grows: in a ramp at
// the limits one of them is possible where the other is not.
TEST(RunClock, EveryEasingOutOfAndIntoARampKeepsTheLimits) {
  const RotationProfile profile({.period_s = 4, .ramp_periods = 2, .rest_before_s = 0});
  const ProfilePeaks peaks = profile.peaks();
  const AxisLimits limits{peaks.rate_radps, peaks.accel_radps2, 1.5 * peaks.jerk_radps3};
  int possible = 0, impossible = 0;
  for (const bool resuming : {false, true})
    for (double at_s = 0.25; at_s < profile.steady_begin_s(); at_s += 0.25) {
      const auto ease_s = ease_s_within(limits, profile, at_s, resuming);
      ++(ease_s ? possible : impossible);
      if (!ease_s) continue;
      RunClock clock;
      double begin_s = at_s;
      clock.hold(at_s, resuming ? 1e-9 : *ease_s);
      if (resuming) {
        clock.read(at_s + 1);
        clock.resume(begin_s = at_s + 1, *ease_s);
      }
      for (double t = begin_s; t < begin_s + *ease_s; t += 0.002) {
        const ProfilePoint p = eased(profile, clock.read(t));
        ASSERT_FALSE(exceeds(limits, p.rate_radps, p.accel_radps2, p.jerk_radps3)) << at_s << ' ' << t;
      }
    }
  EXPECT_GT(possible, 5);
  EXPECT_GT(impossible, 0);
}

}  // namespace
}  // namespace waverig::motion
