#include "motion/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

ProfileSettings random_settings(RandomStream& random) {
  return {.period_s = random.uniform(1, 20),
          .steady_s = random.uniform(10, 400),
          .ramp_periods = 1 + static_cast<int>(random.uniform(0, 5)),
          .rest_before_s = random.uniform(0, 20),
          .rest_after_s = random.uniform(0, 5),
          .direction = random.uniform() < 0.5 ? 1 : -1,
          .rate_modulation = random.uniform(0, 0.2),
          .modulation_cycles = static_cast<int>(random.uniform(0, 4)),
          .rate_drift = random.uniform(-0.2, 0.2)};
}

TEST(Profile, LastsRestRampSteadyRampRest) {
  const RotationProfile profile(
      {.period_s = 6, .steady_s = 300, .ramp_periods = 2, .rest_before_s = 10, .rest_after_s = 2});
  EXPECT_DOUBLE_EQ(profile.steady_begin_s(), 22);
  EXPECT_DOUBLE_EQ(profile.steady_end_s(), 322);
  EXPECT_DOUBLE_EQ(profile.duration_s(), 336);
  EXPECT_EQ(profile.steady_periods(), 50);
}

TEST(Profile, RoundsSteadyDurationUpToWholePeriods) {
  EXPECT_EQ(RotationProfile({.period_s = 7, .steady_s = 300}).steady_periods(), 43);
  EXPECT_EQ(RotationProfile({.period_s = 0.1, .steady_s = 0.3}).steady_periods(),
            3);  // 0.3 / 0.1 > 3 by rounding
}

TEST(Profile, SteadyPartTurnsOnceAPeriod) {
  const RotationProfile profile({.period_s = 6});
  const ProfilePoint a = profile.at(profile.steady_begin_s()), b = profile.at(profile.steady_begin_s() + 60);
  EXPECT_NEAR(b.angle_rad - a.angle_rad, 10 * 2 * pi, 1e-12);
  EXPECT_DOUBLE_EQ(a.rate_radps, 2 * pi / 6);
  EXPECT_EQ(b.accel_radps2, 0);
}

TEST(Profile, EachRampTurnsByHalfItsPeriodsAndBothByWholeTurns) {
  const RotationProfile profile({.period_s = 5, .ramp_periods = 3});
  EXPECT_NEAR(profile.at(profile.steady_begin_s()).angle_rad, 3 * pi, 1e-12);
  EXPECT_NEAR(std::remainder(profile.at(1e9).angle_rad, 2 * pi), 0, 1e-10);
}

TEST(Profile, RampRateIsARaisedCosine) {
  const RotationProfile profile({.period_s = 6, .ramp_periods = 2, .rest_before_s = 10});
  EXPECT_NEAR(profile.at(16).rate_radps, 0.5 * 2 * pi / 6, 1e-14);  // halfway
  EXPECT_NEAR(profile.at(13).rate_radps, 0.5 * (1 - std::sqrt(0.5)) * 2 * pi / 6, 1e-14);
  EXPECT_NEAR(profile.at(16).accel_radps2, 0.5 * (2 * pi / 6) * pi / 12, 1e-14);
}

TEST(Profile, PhasesFollowEachOther) {
  const RotationProfile profile({.period_s = 6, .steady_s = 60, .ramp_periods = 1, .rest_before_s = 10});
  EXPECT_EQ(profile.at(-1).phase, Phase::kRest);
  EXPECT_EQ(profile.at(9.999).phase, Phase::kRest);
  EXPECT_EQ(profile.at(10.001).phase, Phase::kRampIn);
  EXPECT_EQ(profile.at(16.001).phase, Phase::kSteady);
  EXPECT_EQ(profile.at(76.001).phase, Phase::kRampOut);
  EXPECT_EQ(profile.at(82.001).phase, Phase::kStopped);
}

TEST(Profile, RateAccelerationAndJerkAreTheDerivativesAndStayBelowThePeaks) {
  RandomStream random(1, "profile test");
  for (int trial = 0; trial < 200; ++trial) {
    const RotationProfile profile(random_settings(random));
    const ProfilePeaks peaks = profile.peaks();
    for (int i = 0; i < 200; ++i) {
      const double t = random.uniform(-1, profile.duration_s() + 1), h = 1e-4;
      const ProfilePoint a = profile.at(t - h), p = profile.at(t), b = profile.at(t + h);
      ASSERT_NEAR((b.angle_rad - a.angle_rad) / (2 * h), p.rate_radps, 1e-6);
      ASSERT_NEAR((b.rate_radps - a.rate_radps) / (2 * h), p.accel_radps2, 1e-4 * peaks.jerk_radps3 + 1e-6);
      if (a.phase == b.phase) {
        ASSERT_NEAR((b.accel_radps2 - a.accel_radps2) / (2 * h), p.jerk_radps3, 1e-5);
      }
      ASSERT_LE(std::abs(p.rate_radps), peaks.rate_radps * (1 + 1e-12));
      ASSERT_LE(std::abs(p.accel_radps2), peaks.accel_radps2 * (1 + 1e-12));
      ASSERT_LE(std::abs(p.jerk_radps3), peaks.jerk_radps3 * (1 + 1e-12));
    }
  }
}

TEST(Profile, AngleAndRateAreContinuousAtTheSeams) {
  RandomStream random(2, "profile test");
  for (int trial = 0; trial < 100; ++trial) {
    const RotationProfile p(random_settings(random));
    for (const double seam : {p.ramp_begin_s(), p.steady_begin_s(), p.steady_end_s(), p.ramp_end_s()}) {
      const ProfilePoint a = p.at(seam - 1e-9), b = p.at(seam + 1e-9);
      EXPECT_NEAR(a.angle_rad, b.angle_rad, 1e-7);
      EXPECT_NEAR(a.rate_radps, b.rate_radps, 1e-7);
      EXPECT_NEAR(a.accel_radps2, b.accel_radps2, 1e-6);
    }
  }
}

TEST(Profile, ModulationKeepsTheMeanRateAndDriftEndsWhereItSays) {
  const RotationProfile modulated({.period_s = 6, .rate_modulation = 0.1, .modulation_cycles = 3});
  const double turned =
      modulated.at(modulated.steady_end_s()).angle_rad - modulated.at(modulated.steady_begin_s()).angle_rad;
  EXPECT_NEAR(turned, 50 * 2 * pi, 1e-9);
  double most = 0;
  for (double t = 22; t < 322; t += 0.01) most = std::max(most, modulated.at(t).rate_radps);
  EXPECT_NEAR(most, 1.1 * 2 * pi / 6, 1e-4);

  const RotationProfile drifting({.period_s = 6, .rate_drift = 0.05});
  EXPECT_NEAR(drifting.at(drifting.steady_end_s() - 1e-9).rate_radps, 1.05 * 2 * pi / 6, 1e-9);
}

TEST(Profile, TheOtherDirectionIsTheMirrorImage) {
  const RotationProfile up({.period_s = 4}), down({.period_s = 4, .direction = -1});
  for (double t = 0; t < up.duration_s(); t += 0.7)
    EXPECT_DOUBLE_EQ(up.at(t).angle_rad, -down.at(t).angle_rad);
}

TEST(Profile, RefusesWhatMakesNoProfile) {
  EXPECT_THROW(RotationProfile({.period_s = 0}), UserError);
  EXPECT_THROW(RotationProfile({.period_s = std::numeric_limits<double>::quiet_NaN()}), UserError);
  EXPECT_THROW(RotationProfile({.steady_s = -1}), UserError);
  EXPECT_THROW(RotationProfile({.ramp_periods = 0}), UserError);
  EXPECT_THROW(RotationProfile({.direction = 0}), UserError);
  EXPECT_THROW(RotationProfile({.period_s = 1e-3, .steady_s = 1e4}), UserError);  // ten million turns
  EXPECT_THROW(RotationProfile({.rate_modulation = 0.6, .modulation_cycles = 1}), UserError);
  EXPECT_THROW(RotationProfile({.rate_drift = -0.5}), UserError);
  EXPECT_THROW(RotationProfile({.rest_before_s = -1}), UserError);
  try {
    RotationProfile({.period_s = -3});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("period_s = -3"), std::string::npos);
  }
}

}  // namespace
}  // namespace waverig::motion
