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

}  // namespace
}  // namespace waverig::motion
