#include "motion/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "motion/kinematics/random.h"
#include "motion/setpoint_guard.h"

namespace waverig::motion {
namespace {

TEST(Limits, NameTheFirstThatIsBroken) {
  const AxisLimits limits{.rate_radps = 1, .accel_radps2 = 2, .jerk_radps3 = 3};
  EXPECT_FALSE(exceeds(limits, -1, 2, -3));
  EXPECT_EQ(exceeds(limits, 1.01, 9, 9)->kind, LimitKind::kRate);
  EXPECT_EQ(exceeds(limits, 0, -2.01, 9)->kind, LimitKind::kAccel);
  EXPECT_EQ(exceeds(limits, 0, 0, 3.01)->kind, LimitKind::kJerk);
  EXPECT_EQ(exceeds(limits, 0, 0, 3.01)->sentence(),
            "angular jerk 3.01 rad/s^3 is beyond the axis limit 3 rad/s^3");
}

TEST(Limits, HoldNothingThatIsNotANumber) {
  EXPECT_TRUE(exceeds({}, std::numeric_limits<double>::quiet_NaN(), 0, 0));
}

TEST(Limits, AProfileFitsExactlyToItsPeaks) {
  const RotationProfile profile({.period_s = 2, .ramp_periods = 2});
  const ProfilePeaks peaks = profile.peaks();
  AxisLimits limits{peaks.rate_radps, peaks.accel_radps2, peaks.jerk_radps3};
  EXPECT_FALSE(exceeds(limits, profile));
  limits.jerk_radps3 *= 0.999;
  EXPECT_EQ(exceeds(limits, profile)->kind, LimitKind::kJerk);
  limits.accel_radps2 *= 0.999;
  EXPECT_EQ(exceeds(limits, profile)->kind, LimitKind::kAccel);
  limits.rate_radps *= 0.999;
  EXPECT_EQ(exceeds(limits, profile)->kind, LimitKind::kRate);
}

TEST(SetpointGuard, LetsPassEveryProfileWithinItsOwnPeaksAtAnyTiming) {
  RandomStream random(3, "guard test");
  for (int trial = 0; trial < 60; ++trial) {
    const RotationProfile profile({.period_s = random.uniform(1, 20),
                                   .steady_s = 60,
                                   .ramp_periods = 1 + trial % 3,
                                   .rate_modulation = random.uniform(0, 0.1),
                                   .modulation_cycles = trial % 2});
    const ProfilePeaks peaks = profile.peaks();
    SetpointGuard guard({peaks.rate_radps, peaks.accel_radps2, peaks.jerk_radps3});
    for (std::int64_t t = 0; t < 80'000'000; t += 5000 + static_cast<std::int64_t>(random.uniform(0, 10000)))
      ASSERT_FALSE(guard.check(t, 1000 + profile.at(1e-6 * static_cast<double>(t)).angle_rad))
          << trial << " at " << t;
  }
}

TEST(SetpointGuard, CatchesAJumpAKinkAndAnAccelerationStep) {
  const AxisLimits limits{.rate_radps = 2, .accel_radps2 = 5, .jerk_radps3 = 50};
  const auto first_excess = [&](auto angle) -> std::optional<LimitKind> {
    SetpointGuard guard(limits);
    for (int i = -50; i < 50; ++i)
      if (const auto excess = guard.check(i * 10000, angle(0.01 * i))) return excess->kind;
    return std::nullopt;
  };
  EXPECT_EQ(first_excess([](double t) { return t > 0 ? 0.03 : 0; }), LimitKind::kRate);
  EXPECT_EQ(first_excess([](double t) { return t > 0 ? t : 0; }), LimitKind::kAccel);
  EXPECT_EQ(first_excess([](double t) { return t > 0 ? t * t : 0; }), LimitKind::kJerk);
  EXPECT_EQ(first_excess([](double t) { return t > 0 ? 1.5 * t * t * t : 0; }), std::nullopt);
}

TEST(SetpointGuard, ForgetsWhatWasBeforeAReset) {
  SetpointGuard guard({.rate_radps = 1, .accel_radps2 = 1, .jerk_radps3 = 1});
  guard.check(0, 0);
  guard.reset();
  EXPECT_FALSE(guard.check(10000, 5));
}

}  // namespace
}  // namespace waverig::motion
