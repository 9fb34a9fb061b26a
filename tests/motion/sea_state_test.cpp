#include "motion/sea_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

TEST(SeaState, ComponentsCarryTheOrderedHeightExactly) {
  for (const bool random : {false, true}) {
    const auto components = draw_components({.hm0_m = 2.5, .tp_s = 9, .random_amplitudes = random});
    EXPECT_NEAR(moments_of(components).hm0_m(), 2.5, 1e-12);
  }
}

// JONSWAP, gamma 3.3: Tm01 = 0.834 Tp, Tm02 = 0.777 Tp (numerical integral); Pierson-Moskowitz 0.772 and
// 0.710.
TEST(SeaState, MeanPeriodsAreThoseOfTheSpectrum) {
  const SeaMoments jonswap =
      moments_of(draw_components({.tp_s = 10, .components = 2000, .highest_relative = 20}));
  EXPECT_NEAR(jonswap.tm01_s(), 8.345, 0.03);
  EXPECT_NEAR(jonswap.tm02_s(), 7.775, 0.05);
  const SeaMoments pm = moments_of(draw_components(
      {.shape = SpectrumShape::kPiersonMoskowitz, .tp_s = 10, .components = 2000, .highest_relative = 20}));
  EXPECT_NEAR(pm.tm01_s(), 7.718, 0.03);
  EXPECT_NEAR(pm.tm02_s(), 7.104, 0.05);
}

TEST(SeaState, RandomAmplitudesScatterTheEnergyAsAGaussianSeaDoes) {
  // With Rayleigh amplitudes the variance of m0 is the sum of the squared shares.
  const SeaSettings fixed{.random_amplitudes = false, .exact_hm0 = false};
  const auto components = draw_components(fixed);
  double m0 = 0, squares = 0;
  for (const auto& c : components) {
    const double share = 0.5 * c.amplitude_m * c.amplitude_m;
    m0 += share;
    squares += share * share;
  }
  const int trials = 400;
  double sum = 0, sum2 = 0;
  for (int i = 0; i < trials; ++i) {
    const double m = moments_of(draw_components({.random_amplitudes = true,
                                                 .exact_hm0 = false,
                                                 .seed = static_cast<std::uint64_t>(i)}))
                         .m0;
    sum += m;
    sum2 += m * m;
  }
  const double mean = sum / trials, variance = sum2 / trials - mean * mean;
  EXPECT_NEAR(mean, m0, 4 * std::sqrt(squares / trials));
  EXPECT_NEAR(variance / squares, 1, 0.3);
}

TEST(SeaState, SpreadingHasTheMeanAndWidthOfCos2s) {
  for (const double s : {2.0, 10.0, 50.0}) {
    const SeaMoments m = moments_of(
        draw_components({.direction_from_rad = 4, .spreading_s = s, .components = 20000, .seed = 3}));
    EXPECT_NEAR(m.mean_direction_from_rad, 4, 0.04);
    EXPECT_NEAR(m.spread_rad, std::sqrt(2 / (s + 1)), 0.02);  // r1 = s / (s + 1)
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {        // and of a sea of few components
      const SeaMoments few =
          moments_of(draw_components({.direction_from_rad = 4, .spreading_s = s, .seed = seed}));
      EXPECT_NEAR(few.mean_direction_from_rad, 4, 1e-9);
      EXPECT_NEAR(few.spread_rad, std::sqrt(2 / (s + 1)), 0.017);
    }
  }
  const SeaMoments m = moments_of(draw_components({.direction_from_rad = 1}));
  EXPECT_NEAR(m.mean_direction_from_rad, 1, 1e-12);
  EXPECT_NEAR(m.spread_rad, 0, 1e-6);
}

TEST(SeaState, SampledMotionHasTheMomentsOfItsComponents) {
  const SeaSettings settings{.hm0_m = 2, .tp_s = 6, .spreading_s = 8, .components = 300, .seed = 11};
  const auto components = draw_components(settings);
  const SeaMoments m = moments_of(components);
  SeaMotion motion(components, {});
  double p2 = 0, v2 = 0, a2 = 0, h2 = 0;
  const int n = 400'000;  // 22 h: the sampling scatter is below a percent
  for (int i = 0; i < n; ++i) {
    const BodyMotion b = motion.at(i * 200'000LL);
    p2 += b.position_N.z() * b.position_N.z();
    v2 += b.velocity_N.z() * b.velocity_N.z();
    a2 += b.acceleration_N.z() * b.acceleration_N.z();
    h2 += b.position_N.head<2>().squaredNorm();
  }
  EXPECT_NEAR(p2 / n / m.m0, 1, 0.01);
  EXPECT_NEAR(v2 / n / (m.m2 * std::pow(2 * pi, 2)), 1, 0.01);
  EXPECT_NEAR(a2 / n / (m.m4 * std::pow(2 * pi, 4)), 1, 0.01);
  EXPECT_NEAR(h2 / p2, 1, 0.01);  // deep water: circular orbits, check factor 1
}

TEST(SeaState, IsTheSumOfItsComponents) {
  const auto components = draw_components({.hm0_m = 1, .tp_s = 3, .spreading_s = 5});
  SeaMotion motion(components, {.slope_following = 0});
  for (int i = 0; i < 60; ++i) {
    const std::int64_t utime = 20'000'003LL * i - 100'000'000;
    const double t = 1e-6 * static_cast<double>(utime);
    double up = 0, north = 0, accel_east = 0;
    for (const auto& c : components) {
      const double phase = c.w_radps * t + c.phase_rad;
      up += c.amplitude_m * std::cos(phase);
      north += c.amplitude_m * std::cos(c.towards_rad) * std::sin(phase);
      accel_east -= c.amplitude_m * std::sin(c.towards_rad) * c.w_radps * c.w_radps * std::sin(phase);
    }
    const BodyMotion b = motion.at(utime);
    EXPECT_NEAR(heave_m(b), up, 1e-8);
    EXPECT_NEAR(b.position_N.x(), north, 1e-8);
    EXPECT_NEAR(b.acceleration_N.y(), accel_east, 5e-5);
    EXPECT_EQ(b.w_NB_B.norm(), 0);
  }
}

FloatSettings lively() {
  return {.slope_following = 1,
          .heading_rad = 1,
          .tilt_rad = 0.2,
          .tilt_period_s = 2.7,
          .heading_wander_rad = 0.5,
          .heading_wander_period_s = 30};
}

TEST(SeaState, VelocityAccelerationAndAngularRateAreDerivatives) {
  SeaMotion motion(draw_components({.hm0_m = 1.5, .tp_s = 5, .spreading_s = 5}), lively());
  for (int i = 0; i < 300; ++i) {
    const std::int64_t t = 777'777LL * i, h_us = 200;
    const double h = 1e-6 * static_cast<double>(h_us);
    const BodyMotion a = motion.at(t - h_us), m = motion.at(t), b = motion.at(t + h_us);
    EXPECT_LT(((b.position_N - a.position_N) / (2 * h) - m.velocity_N).norm(), 1e-6);
    EXPECT_LT(((b.velocity_N - a.velocity_N) / (2 * h) - m.acceleration_N).norm(), 1e-5);
    const Quaterniond turned = a.q_NB.conjugate() * b.q_NB;  // exp(w 2h)
    const Vector3d rate = 2 * turned.vec() * (turned.w() < 0 ? -1 : 1) / (2 * h);
    EXPECT_LT((rate - m.w_NB_B).norm(), 1e-5);
  }
}

TEST(SeaState, BodyThatFollowsTheSlopeFeelsNoSidewaysForceToFirstOrder) {
  SeaMotion motion(draw_components({.hm0_m = 0.05, .tp_s = 6, .spreading_s = 5}), {.slope_following = 1});
  SeaMotion level(draw_components({.hm0_m = 0.05, .tp_s = 6, .spreading_s = 5}), {.slope_following = 0});
  const Vector3d g_N(0, 0, kStandardGravity);
  double following = 0, staying = 0;
  for (int i = 0; i < 2000; ++i) {
    following += specific_force_B(motion.at(100'000LL * i), g_N).head<2>().squaredNorm();
    staying += specific_force_B(level.at(100'000LL * i), g_N).head<2>().squaredNorm();
  }
  EXPECT_LT(std::sqrt(following / staying), 0.02);
}

TEST(SeaState, WaveFromTheSouthRunsNorthAndLiftsTheBowBeforeItsCrest) {
  // One component, towards north, crest at t = 0.
  SeaMotion motion({{.w_radps = 1, .amplitude_m = 1, .phase_rad = 0, .towards_rad = 0}}, {});
  const BodyMotion crest = motion.at(0);
  EXPECT_NEAR(heave_m(crest), 1, 1e-9);
  EXPECT_NEAR(crest.velocity_N.x(), 1, 1e-7);       // the crest's water runs forward
  const BodyMotion before = motion.at(-1'570'796);  // the crest is still to the south: the stern is high
  EXPECT_LT(euler_of(before.q_NB).pitch_rad, -0.05);
  EXPECT_NEAR(std::tan(euler_of(motion.at(1'570'796).q_NB).pitch_rad), 1 / kStandardGravity, 1e-3);
  const SeaMoments m = moments_of({{.w_radps = 1, .amplitude_m = 1, .phase_rad = 0, .towards_rad = 0}});
  EXPECT_NEAR(m.mean_direction_from_rad, pi, 1e-12);
}

TEST(SeaState, AnswersDoNotDependOnTheOrderOfQuestions) {
  const auto components = draw_components({.components = 100});
  SeaMotion ascending(components, lively()), other(components, lively());
  std::vector<BodyMotion> expected;
  for (int i = 0; i < 400; ++i) expected.push_back(ascending.at(123'457LL * i));
  for (int i = 399; i >= 0; i -= 7) {
    const BodyMotion b = other.at(123'457LL * i);
    EXPECT_EQ(b.position_N, expected[static_cast<std::size_t>(i)].position_N);
    EXPECT_EQ(b.w_NB_B, expected[static_cast<std::size_t>(i)].w_NB_B);
  }
}

TEST(SeaState, BeginsWhenItIsTold) {
  FloatSettings settings = lively();
  SeaMotion sea(draw_components({}), settings);
  settings.start_utime = 1'700'000'000'000'000;
  SeaMotion later(draw_components({}), settings);
  const BodyMotion a = sea.at(12'345'678), b = later.at(settings.start_utime + 12'345'678);
  EXPECT_EQ(a.position_N, b.position_N);
  EXPECT_EQ(a.q_NB.coeffs(), b.q_NB.coeffs());
}

TEST(SeaState, SameSeedSameSeaOtherSeedOtherSea) {
  const auto a = draw_components({.seed = 5}), b = draw_components({.seed = 5}),
             c = draw_components({.seed = 6});
  EXPECT_EQ(a[17].phase_rad, b[17].phase_rad);
  EXPECT_EQ(a[17].w_radps, b[17].w_radps);
  EXPECT_NE(a[17].phase_rad, c[17].phase_rad);
  const auto tilted = [&](std::uint64_t seed) {  // and how the float sways is its own
    return SeaMotion(a, {.slope_following = 0, .tilt_rad = 0.1, .tilt_period_s = 3, .seed = seed}).at(0).q_NB;
  };
  EXPECT_EQ(tilted(5).coeffs(), tilted(5).coeffs());
  EXPECT_NE(tilted(5).coeffs(), tilted(6).coeffs());
}

TEST(SeaState, RefusesNonsense) {
  EXPECT_THROW(draw_components({.components = 0}), UserError);
  EXPECT_THROW(draw_components({.spreading_s = -1}), UserError);
  EXPECT_THROW(draw_components({.tp_s = 0}), UserError);
  EXPECT_THROW(SeaMotion({}, {}), UserError);
  EXPECT_THROW(SeaMotion(draw_components({}), {.tilt_rad = 0.1}), UserError);
}

}  // namespace
}  // namespace waverig::motion
