#include "motion/kinematics/strapdown.h"

#include <gtest/gtest.h>

#include <functional>

namespace waverig {
namespace {

constexpr double kEarthRate = 7.292115e-5;  // rad/s

struct SensorInput {
  Vector3d w_ib_B, f_B;
};
using Signal = std::function<SensorInput(double t_s)>;

// The integrals over [t, t + dt] to machine precision: five-point Gauss-Legendre on four panels.
Increments integrated(const Signal& signal, double t_s, double dt_s) {
  constexpr double x[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                          0.9061798459386640};
  constexpr double w[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                          0.2369268850561891};
  Increments sum{.dt_s = dt_s};
  const double h = dt_s / 4;
  for (int panel = 0; panel < 4; ++panel) {
    for (int i = 0; i < 5; ++i) {
      const SensorInput input = signal(t_s + h * (panel + 0.5 * (1 + x[i])));
      sum.angle_B += 0.5 * h * w[i] * input.w_ib_B;
      sum.velocity_B += 0.5 * h * w[i] * input.f_B;
    }
  }
  return sum;
}

NavigationState at_latitude(double latitude_deg) { return {.place = {latitude_deg * kDegree, 0, 0}}; }

double angle_between(const Quaterniond& a, const Quaterniond& b) { return a.angularDistance(b); }

TEST(Strapdown, StaysWhereItIsAtRest) {
  NavigationState start = at_latitude(37.5);
  start.q_NB = quaternion_of({0.2, -0.1, 1.0});
  const LocalEarth local = local_earth(start.place);
  const BodyMotion rest{.q_NB = start.q_NB};
  StrapdownNavigator navigator(start);
  const double dt = 0.02;
  const Increments increments{inertial_rate_B(rest, local) * dt, specific_force_B(rest, local) * dt, dt};
  for (int i = 0; i < 50 * 600; ++i) navigator.add(increments);  // ten minutes
  EXPECT_LT(navigator.state().velocity_N.norm(), 1e-6);
  EXPECT_LT(std::abs(navigator.state().place.height_m), 1e-3);
  EXPECT_LT(std::abs(navigator.state().place.latitude_rad - start.place.latitude_rad) * 6.4e6, 1e-3);
  EXPECT_LT(angle_between(navigator.state().q_NB, start.q_NB), 1e-9);
}

// The first few seconds of a fall from rest: z = g t^2 / 2, and w g t^3 cos(latitude) / 3 towards the east.
TEST(Strapdown, FallsFreelyAndDriftsEast) {
  const NavigationState start = at_latitude(40);
  const LocalEarth local = local_earth(start.place);
  StrapdownNavigator navigator(start);
  const double dt = 0.01, duration = 10;
  const Increments nothing{.angle_B = local.w_ie_N * dt, .dt_s = dt};
  for (int i = 0; i < 1000; ++i) navigator.add(nothing);
  const NavigationState& end = navigator.state();
  const double g = local.g_N.norm();
  EXPECT_NEAR(-end.place.height_m, 0.5 * g * duration * duration,
              0.02);  // 3e-6 per metre: gravity's own growth
  const double cos_latitude = std::cos(40 * kDegree);
  const double east_m = end.place.longitude_rad * local.east_radius_m * cos_latitude;
  const double expected_m = kEarthRate * g * std::pow(duration, 3) * cos_latitude / 3;
  EXPECT_NEAR(east_m, expected_m, 2e-3 * expected_m);
}

// A frictionless puck, held up by exactly the weight: it leaves the straight line by w sin(latitude) v t^2 to
// the right in the north.
TEST(Strapdown, DeflectsAPuckToTheRightInTheNorthAndLeftInTheSouth) {
  for (const double latitude_deg : {50.0, -50.0}) {
    NavigationState start = at_latitude(latitude_deg);
    start.velocity_N = {10, 0, 0};
    StrapdownNavigator navigator(start);
    const double dt = 0.1, duration = 60;
    for (int i = 0; i < 600; ++i) {
      const NavigationState& now = navigator.state();
      const LocalEarth local = local_earth(now.place);
      const BodyMotion level{.velocity_N = now.velocity_N, .q_NB = now.q_NB};
      const Vector3d f_B = now.q_NB.conjugate() * (-local.g_N);
      navigator.add({inertial_rate_B(level, local) * dt, f_B * dt, dt});
    }
    const LocalEarth local = local_earth(start.place);
    const double east_m =
        navigator.state().place.longitude_rad * local.east_radius_m * std::cos(start.place.latitude_rad);
    const double expected_m = kEarthRate * std::sin(start.place.latitude_rad) * 10 * duration * duration;
    EXPECT_NEAR(east_m, expected_m, 5e-3 * std::abs(expected_m));
  }
}

// An initial velocity error of a resting navigator swings as V cos(w_s t), w_s^2 = g / R: 84.4 minutes.
TEST(Strapdown, SwingsWithTheSchulerPeriod) {
  NavigationState start = at_latitude(0);  // at the equator there is no Foucault precession of the swing
  const LocalEarth local = local_earth(start.place);
  const double v = 0.1;
  start.velocity_N = {v, 0, 0};
  StrapdownNavigator navigator(start);
  const double dt = 0.5, schuler = std::sqrt(local.g_N.norm() / local.north_radius_m);
  const BodyMotion rest;
  const Increments increments{inertial_rate_B(rest, local) * dt, specific_force_B(rest, local) * dt, dt};
  const int half_period = static_cast<int>(std::numbers::pi / schuler / dt);
  EXPECT_NEAR(2 * std::numbers::pi / schuler / 60, 84.4, 0.4);
  double largest_m = 0;
  for (int i = 1; i <= half_period; ++i) {
    navigator.add(increments);
    const double t = i * dt;
    EXPECT_NEAR(navigator.state().velocity_N.x(), v * std::cos(schuler * t), 0.01 * v);
    largest_m = std::max(largest_m, navigator.state().place.latitude_rad * local.north_radius_m);
  }
  EXPECT_NEAR(largest_m, v / schuler, 0.01 * v / schuler);
}

// Classic coning: the body's axis runs round a cone of half-angle `cone`, attitude known in closed form.
struct Coning {
  double cone_rad, rate_radps;
  Quaterniond q_NB(double t) const {
    const double s = std::sin(cone_rad / 2), phase = rate_radps * t;
    return {std::cos(cone_rad / 2), s * std::cos(phase), s * std::sin(phase), 0};
  }
  Vector3d w_NB_B(double t) const {
    const double phase = rate_radps * t, s = std::sin(cone_rad);
    return rate_radps *
           Vector3d(-s * std::sin(phase), s * std::cos(phase), -2 * std::pow(std::sin(cone_rad / 2), 2));
  }
};

TEST(Strapdown, FollowsConingThatPlainSumsMiss) {
  const Coning coning{2 * kDegree, 2 * std::numbers::pi * 5};
  NavigationState start = at_latitude(45);
  start.q_NB = coning.q_NB(0);
  const LocalEarth local = local_earth(start.place);
  const Signal signal = [&](double t) {
    const BodyMotion motion{.q_NB = coning.q_NB(t), .w_NB_B = coning.w_NB_B(t)};
    return SensorInput{inertial_rate_B(motion, local), specific_force_B(motion, local)};
  };
  StrapdownNavigator navigator(start);
  Quaterniond plain = start.q_NB;
  const double dt = 0.01, duration = 60;
  for (int i = 0; i < 6000; ++i) {
    const Increments increments = integrated(signal, i * dt, dt);
    navigator.add(increments);
    plain = quaternion_exp(-local.w_ie_N * dt) * plain * quaternion_exp(increments.angle_B);
  }
  const double drift = angle_between(navigator.state().q_NB, coning.q_NB(duration));
  const double plain_drift = angle_between(plain, coning.q_NB(duration));
  EXPECT_GT(plain_drift, 1 * kDegree);  // rectified by the missing term
  EXPECT_LT(drift, 0.02 * plain_drift);
}

// Sculling: rocking about x in phase with a force along y pushes along z by half the product of the
// amplitudes.
TEST(Strapdown, FollowsScullingThatPlainSumsMiss) {
  const double rock_rad = 1 * kDegree, shake_mps2 = 5, rate = 2 * std::numbers::pi * 10;
  const NavigationState start = at_latitude(0);
  const LocalEarth local = local_earth(start.place);
  const auto attitude = [&](double t) { return quaternion_of({rock_rad * std::sin(rate * t), 0, 0}); };
  const auto f_B = [&](double t) -> Vector3d {
    return Vector3d(0, shake_mps2 * std::sin(rate * t), 0) - attitude(t).conjugate() * local.g_N;
  };
  const Signal signal = [&](double t) {
    const BodyMotion motion{.q_NB = attitude(t), .w_NB_B = {rock_rad * rate * std::cos(rate * t), 0, 0}};
    return SensorInput{inertial_rate_B(motion, local), f_B(t)};
  };
  StrapdownNavigator navigator(start);
  double plain_mps = 0;  // vertical velocity with the attitude of the interval's start and no sculling
  const double dt = 0.01;
  const int steps = 1000;  // 10 s: whole periods
  for (int i = 0; i < steps; ++i) {
    const Increments increments = integrated(signal, i * dt, dt);
    plain_mps += (navigator.state().q_NB * increments.velocity_B).z() + local.g_N.z() * dt;
    navigator.add(increments);
  }
  // f_N,z = shake sin(x) sin(rock sin x), mean shake J1(rock) -> shake rock / 2 to first order.
  const double expected_mps = shake_mps2 * std::cyl_bessel_j(1, rock_rad) * steps * dt;
  const double error_mps = std::abs(navigator.state().velocity_N.z() - expected_mps);
  const double plain_error_mps = std::abs(plain_mps - expected_mps);
  EXPECT_LT(error_mps, 0.01 * expected_mps);
  EXPECT_GT(plain_error_mps, 0.05 * expected_mps);
}

// The rig: a gondola on an arm, swinging, at a place; one more way to its trajectory.
TEST(Strapdown, RecoversTheOrbitOfASwingingGondola) {
  const double radius_m = 0.5, rate = 2 * std::numbers::pi / 6, swing_rad = 5 * kDegree;
  const NavigationState place = at_latitude(36);
  const LocalEarth local = local_earth(place.place);
  const auto motion_at = [&](double t) {
    BodyMotion motion;
    const double p = rate * t;
    motion.position_N = radius_m * Vector3d(std::cos(p), 0, -std::sin(p));
    motion.velocity_N = radius_m * rate * Vector3d(-std::sin(p), 0, -std::cos(p));
    motion.acceleration_N = -rate * rate * motion.position_N;
    motion.q_NB = quaternion_of({0, swing_rad * std::sin(p), 0});
    motion.w_NB_B = {0, swing_rad * rate * std::cos(p), 0};
    return motion;
  };
  const Signal signal = [&](double t) {
    return SensorInput{inertial_rate_B(motion_at(t), local), specific_force_B(motion_at(t), local)};
  };
  NavigationState start = place;
  start.velocity_N = motion_at(0).velocity_N;
  start.q_NB = motion_at(0).q_NB;
  StrapdownNavigator navigator(start);
  double t = 0;
  for (int i = 0; i < 6000; ++i) {
    const double dt = i % 3 == 0 ? 0.012 : 0.009;  // a converter whose intervals are not equal
    navigator.add(integrated(signal, t, dt));
    t += dt;
    const double heave = navigator.state().place.height_m;
    EXPECT_NEAR(heave, heave_m(motion_at(t)), 3e-3);
  }
}

TEST(Strapdown, IgnoresAnIntervalWithoutLength) {
  StrapdownNavigator navigator(at_latitude(10));
  navigator.add({Vector3d(1, 1, 1), Vector3d(1, 1, 1), 0});
  EXPECT_EQ(navigator.state().velocity_N.norm(), 0);
  EXPECT_EQ(angle_between(navigator.state().q_NB, Quaterniond::Identity()), 0);
}

}  // namespace
}  // namespace waverig
