#include "motion/regular_wave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

TEST(RegularWave, GoesFromCrestToTroughInHalfAPeriodOnACircle) {
  const RegularWave wave({.period_s = 6, .height_m = 1});
  EXPECT_NEAR(heave_m(wave.at(0)), 0.5, 1e-12);
  EXPECT_NEAR(heave_m(wave.at(3'000'000)), -0.5, 1e-12);
  for (int i = 0; i < 60; ++i) EXPECT_NEAR(wave.at(100'000LL * i).position_N.norm(), 0.5, 1e-12);
}

TEST(RegularWave, VelocityAccelerationAndAngularRateAreDerivatives) {
  const RegularWave wave({.period_s = 5,
                          .height_m = 2,
                          .amplitude_modulation = 0.3,
                          .modulation_period_s = 40,
                          .frequency_drift_1ps = 1e-3,
                          .orbit_ratio = 0.8,
                          .towards_rad = 0.7,
                          .tilt_rad = 0.3,
                          .heading_rad = 2});
  for (int i = 0; i < 300; ++i) {
    const std::int64_t t = 333'333LL * i, h_us = 100;
    const double h = 1e-4;
    const BodyMotion a = wave.at(t - h_us), m = wave.at(t), b = wave.at(t + h_us);
    EXPECT_LT(((b.position_N - a.position_N) / (2 * h) - m.velocity_N).norm(), 1e-7);
    EXPECT_LT(((b.velocity_N - a.velocity_N) / (2 * h) - m.acceleration_N).norm(), 1e-7);
    const Quaterniond turned = a.q_NB.conjugate() * b.q_NB;
    EXPECT_LT((turned.vec() / h - m.w_NB_B).norm(), 1e-6);
  }
}

// Its crest runs forward; a quarter of a period later the wave ahead is higher, and the bow with it.
TEST(RegularWave, RunsTowardsItsDirectionAndLiftsTheBowBehindTheCrest) {
  for (const double towards : {0.0, 0.8, -2.0}) {
    const Vector3d way_N(std::cos(towards), std::sin(towards), 0);
    const RegularWave ahead({.period_s = 6, .towards_rad = towards, .tilt_rad = 0.1, .heading_rad = towards});
    EXPECT_NEAR(ahead.at(0).velocity_N.dot(way_N), pi / 6, 1e-12);
    EXPECT_NEAR((ahead.at(0).velocity_N - pi / 6 * way_N).norm(), 0, 1e-12);
    const Euler behind_crest = euler_of(ahead.at(1'500'000).q_NB);
    EXPECT_NEAR(behind_crest.pitch_rad, 0.1, 1e-12);
    EXPECT_NEAR(behind_crest.roll_rad, 0, 1e-12);
    EXPECT_NEAR(std::remainder(behind_crest.yaw_rad - towards, 2 * pi), 0, 1e-12);
  }
}

TEST(RegularWave, BeginsWhenItIsTold) {
  const RegularWave wave({.period_s = 5}), later({.period_s = 5, .start_utime = 7'000'000});
  EXPECT_EQ(later.at(8'300'000).position_N, wave.at(1'300'000).position_N);
}

TEST(RegularWave, AmplitudeModulationReachesItsDepth) {
  const RegularWave wave(
      {.period_s = 5, .height_m = 2, .amplitude_modulation = 0.25, .modulation_period_s = 200});
  double highest = 0;
  for (int i = 0; i < 20000; ++i) highest = std::max(highest, heave_m(wave.at(10'000LL * i)));
  EXPECT_NEAR(highest, 1.25, 2e-3);
}

TEST(RegularWave, FrequencyDriftsAsSaid) {
  const RegularWave wave({.period_s = 5, .frequency_drift_1ps = 1e-3});
  int crests = 0;
  for (int i = 0; i < 20000; ++i)
    if (wave.at(10'000LL * i).velocity_N.z() <= 0 && wave.at(10'000LL * (i + 1)).velocity_N.z() > 0) ++crests;
  EXPECT_NEAR(crests, 40 * 1.1, 1);  // 200 s, mean frequency 10 % up
}

TEST(RegularWave, RefusesNonsense) {
  EXPECT_THROW(RegularWave({.period_s = 0}), UserError);
  EXPECT_THROW(RegularWave({.amplitude_modulation = 0.1}), UserError);
}

}  // namespace
}  // namespace waverig::motion
