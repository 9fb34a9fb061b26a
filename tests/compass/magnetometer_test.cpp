#include "rig/sensors/magnetometer.h"

#include <gtest/gtest.h>

#include "estimator/compass/heading.h"

namespace waverig::rig {
namespace {

MagnetometerSettings clean() { return {.earth = {.total_uT = 48, .dip_rad = 60 * kDegree}}; }

Vector3d reading_uT(Magnetometer& magnetometer, const MagnetometerSettings& settings,
                    const BodyMotion& motion) {
  return magnetometer.sample(motion).cast<double>() * magnetometer_count_uT(settings);
}

TEST(Magnetometer, WithoutEffectsShowsTheEarthsFieldInTheBody) {
  MagnetometerSettings settings = clean();
  settings.earth.declination_rad = -8 * kDegree;
  Magnetometer magnetometer(settings, {}, 1);
  BodyMotion motion;
  motion.q_NB = quaternion_of({0.2, -0.3, 1.0});
  const Vector3d m_B = reading_uT(magnetometer, settings, motion);
  EXPECT_NEAR(m_B.norm(), 48, 0.002);
  const estimator::Tilt tilt{0.2, -0.3};
  EXPECT_NEAR(estimator::heading_rad(m_B, tilt), 1.0 + 8 * kDegree, 1e-4);  // magnetic = true - declination
  EXPECT_NEAR(estimator::dip_rad(m_B, tilt), 60 * kDegree, 1e-4);
}

TEST(Magnetometer, IronDistortsTheFieldAffinely) {
  const MagnetometerSettings settings = clean();
  MagnetometerParameters unit;
  unit.soft_iron << 1.1, 0.02, 0, 0.01, 0.9, 0.03, 0, 0, 1.0;
  unit.hard_iron_uT = {5, -7, 11};
  Magnetometer distorted(settings, unit, 1), straight(settings, {}, 1);
  BodyMotion motion;
  motion.q_NB = quaternion_of({0.5, 0.1, -2.0});
  const Vector3d expected = unit.soft_iron * reading_uT(straight, settings, motion) + unit.hard_iron_uT;
  EXPECT_LT((reading_uT(distorted, settings, motion) - expected).norm(), 0.005);
}

TEST(MotorField, IsADipolesOnAxisAndAcross) {
  const MotorFieldSettings motor{.stator_moment_N_Am2 = {2, 0, 0}};
  EXPECT_LT((motor_field_N_uT(motor, {0.5, 0, 0}) - Vector3d(3.2, 0, 0)).norm(),
            1e-12);  // mu0 m / (2 pi r^3)
  EXPECT_LT((motor_field_N_uT(motor, {0, 0.5, 0}) - Vector3d(-1.6, 0, 0)).norm(),
            1e-12);  // half, the other way
  EXPECT_EQ(motor_field_N_uT(motor, Vector3d::Zero()).norm(), 0);
}

TEST(MotorField, OfTheRotorKeepsItsStrengthAndTurnsWithTheArm) {
  const MotorFieldSettings motor{.azimuth_rad = 0.4, .rotor_moment_Am2 = {1, 0, 0}};
  for (double angle = 0; angle < 6; angle += 0.5) {
    const Vector3d position =
        0.5 * Vector3d(std::cos(angle) * std::cos(0.4), std::cos(angle) * std::sin(0.4), -std::sin(angle));
    const Vector3d field = motor_field_N_uT(motor, position);
    EXPECT_LT((field - 1.6 * position.normalized()).norm(), 1e-12);
  }
}

// What lies across the way to the sensor has half the field there, the other way.
TEST(MotorField, OfTheRotorAcrossTheArmAndAlongItsAxisTurnsWithTheArmToo) {
  const double azimuth = 0.4;
  const Vector3d outwards(std::cos(azimuth), std::sin(azimuth), 0),
      axis(-std::sin(azimuth), std::cos(azimuth), 0);
  for (double angle = 0; angle < 6; angle += 0.5) {
    const Vector3d along = std::cos(angle) * outwards - std::sin(angle) * Vector3d::UnitZ();
    const Vector3d onwards =
        -std::sin(angle) * outwards - std::cos(angle) * Vector3d::UnitZ();  // as angle grows
    const auto field = [&](const Vector3d& moment_Am2) {
      return motor_field_N_uT({.azimuth_rad = azimuth, .rotor_moment_Am2 = moment_Am2}, 0.5 * along);
    };
    EXPECT_LT((field({0, 1, 0}) + 0.8 * onwards).norm(), 1e-12) << angle;
    EXPECT_LT((field({0, 0, 1}) + 0.8 * axis).norm(), 1e-12) << angle;
  }
}

TEST(MotorField, OfTheStatorChangesAsTheArmTurns) {
  MagnetometerSettings settings = clean();
  settings.motor.stator_moment_N_Am2 = {0, 0, 1};
  Magnetometer magnetometer(settings, {}, 1);
  BodyMotion side, top;
  side.position_N = {0.5, 0, 0};
  top.position_N = {0, 0, -0.5};
  const Vector3d a = reading_uT(magnetometer, settings, side);
  top.utime = 10;
  const Vector3d b = reading_uT(magnetometer, settings, top);
  EXPECT_NEAR((b - a).z(), 1.6 + 0.8, 0.01);
}

TEST(Magnetometer, NoiseIsItsSigmaAndHeldBetweenConversions) {
  MagnetometerSettings settings = mag3110();
  settings.output_rate_Hz = 80;
  Magnetometer magnetometer(settings, {}, 3);
  BodyMotion motion;
  double sum = 0, square = 0;
  int changes = 0;
  double last = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    motion.utime = i * 10000;  // 100 Hz
    const double x = reading_uT(magnetometer, settings, motion).x();
    sum += x;
    square += x * x;
    changes += x != last;
    last = x;
  }
  const double mean = sum / n, sigma = std::sqrt(square / n - mean * mean);
  EXPECT_NEAR(mean, 50 * std::cos(50 * kDegree), 0.01);
  EXPECT_NEAR(sigma, std::hypot(0.25, 0.1 / std::sqrt(12)), 0.01);
  EXPECT_LT(changes, 0.81 * n);  // of 100 samples a second 80 are new, less those that repeat by chance
  EXPECT_GT(changes, 0.6 * n);
}

TEST(Magnetometer, ShowsTheOverflowCodeOrItsLimit) {
  MagnetometerParameters unit;
  unit.hard_iron_uT = {500, 0, 0};
  MagnetometerSettings settings = hmc5883l();
  Magnetometer hmc(settings, unit, 1);
  EXPECT_EQ(hmc.sample({}).x(), -4096);
  EXPECT_TRUE(hmc.saturated());
  Magnetometer mag(mag3110(), {.hard_iron_uT = {-5000, 0, 0}}, 1);
  EXPECT_EQ(mag.sample({}).x(), -10000);
  Magnetometer quiet(hmc5883l(), {}, 1);
  quiet.sample({});
  EXPECT_FALSE(quiet.saturated());
}

TEST(Magnetometer, RepeatsWithItsSeedAndNotWithAnother) {
  const MagnetometerSettings settings = mag3110();
  EXPECT_EQ(draw_magnetometer(settings, 5).hard_iron_uT, draw_magnetometer(settings, 5).hard_iron_uT);
  EXPECT_NE(draw_magnetometer(settings, 5).hard_iron_uT, draw_magnetometer(settings, 6).hard_iron_uT);
}

}  // namespace
}  // namespace waverig::rig
