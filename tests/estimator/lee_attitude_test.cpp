#include "estimator/attitude/lee_attitude.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kG = kStandardGravity;

Vector3d force_at_rest(const Euler& e) { return quaternion_of(e).conjugate() * Vector3d(0, 0, -kG); }

Euler random_tilt(RandomStream& random) {
  return {random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-3, 3)};
}

// Lee 2014, eq. (9) as printed: the inverse rotations.
Vector3d levelled_as_printed(const Vector3d& f, double roll, double pitch) {
  const double y = std::cos(roll) * f.y() + std::sin(roll) * f.z();
  const double z = -std::sin(roll) * f.y() + std::cos(roll) * f.z();
  return {std::cos(pitch) * f.x() - std::sin(pitch) * z, y, std::sin(pitch) * f.x() + std::cos(pitch) * z};
}

TEST(Levelling, GivesMinusGravityAtRestForAnyTilt) {
  RandomStream random(1, "tilt");
  for (int i = 0; i < 200; ++i) {
    const Euler e = random_tilt(random);
    const Vector3d f_N = levelled(force_at_rest(e), e.roll_rad, e.pitch_rad);
    ASSERT_LT((f_N - Vector3d(0, 0, -kG)).norm(), 1e-12 * kG);
  }
}

TEST(Levelling, RotationPrintedInThePaperDoublesTheTiltInsteadOfTakingItOut) {
  for (const double tilt : {0.02, 0.1, 0.3}) {
    const Vector3d f_N = levelled_as_printed(force_at_rest({tilt, 0, 0}), tilt, 0);
    EXPECT_NEAR(std::hypot(f_N.x(), f_N.y()), kG * std::sin(2 * tilt), 1e-12);
    EXPECT_GT((f_N - Vector3d(0, 0, -kG)).norm(), 1.9 * kG * tilt);
  }
}

TEST(RestAttitude, IsTheRollAndPitchOfTheFrame) {
  RandomStream random(2, "tilt");
  for (int i = 0; i < 200; ++i) {
    const Euler e = random_tilt(random), found = rest_attitude(force_at_rest(e), kG);
    ASSERT_NEAR(found.roll_rad, e.roll_rad, 1e-9);
    ASSERT_NEAR(found.pitch_rad, e.pitch_rad, 1e-9);
  }
}

TEST(LeeAttitude, FollowsASlowTurnOfTheFrame) {
  LeeAttitude attitude({});
  const double dt = 0.01, rate = 0.02;
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Euler e{rate * i * dt, 0.1, 0};
    // d/dt of roll with pitch fixed is the rate about the body's x axis.
    const Euler found = euler_of(attitude.update(force_at_rest(e), Vector3d(rate, 0, 0), i == 0 ? 0 : dt));
    worst = std::max({worst, std::abs(found.roll_rad - e.roll_rad), std::abs(found.pitch_rad - e.pitch_rad)});
  }
  EXPECT_LT(worst, 1e-4);
}

// A quaternion and its opposite are one attitude: over half a turn what is measured changes its sign, and
// taken as it comes would drive the frame out of the level instead of into it.
TEST(LeeAttitude, StaysLevelHoweverOftenTheBodyTurnsRound) {
  LeeAttitude attitude({});
  const double dt = 0.01, rate = 0.5, bias = 1e-3;
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    attitude.update(Vector3d(0, 0, -kG), Vector3d(bias, 0, rate), i == 0 ? 0 : dt);
    const Euler found = euler_of(attitude.q_NB());
    worst = std::max(worst, std::hypot(found.roll_rad, found.pitch_rad));
    ASSERT_NEAR(std::remainder(found.yaw_rad - rate * i * dt, 2 * std::numbers::pi), 0, 0.01) << i;
  }
  EXPECT_LT(worst, bias / rate * 1.1);  // the bias turns with the body, so that its lean stays below this
}

TEST(LeeAttitude, LeansByGyroBiasTimesItsTimeConstant) {
  const LeeAttitudeSettings settings;
  LeeAttitude attitude(settings);
  const double dt = 0.01, bias = 0.2 * kDegree;
  for (int i = 0; i < 5000; ++i) attitude.update(Vector3d(0, 0, -kG), Vector3d(bias, 0, 0), i == 0 ? 0 : dt);
  // Steady gain k of a random walk of variance Q seen with variance R: k^2 R = (1 - k) Q; time constant dt (1
  // - k) / k.
  const double q = settings.gyro_noise_radps_rthz * settings.gyro_noise_radps_rthz * dt / 2;
  const double angle = settings.accel_noise_mps2_rthz / kG, r = angle * angle / (2 * dt);
  const double k = (-q + std::sqrt(q * q + 4 * q * r)) / (2 * r);
  EXPECT_NEAR(euler_of(attitude.q_NB()).roll_rad, bias * dt * (1 - k) / k, 0.02 * bias);
}

}  // namespace
}  // namespace waverig::estimator
