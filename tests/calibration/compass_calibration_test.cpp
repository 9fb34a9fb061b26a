// The compass in a calibration file, and what both ways to it come to.
#include "estimator/compass/compass_calibration.h"

#include <gtest/gtest.h>

#include "estimator/calibration/accelerometer_calibration.h"
#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kField_uT = 48, kDip = 60 * kDegree;

struct Turned {
  std::vector<Vector3d> raw_uT, f_B;
};

Turned turned(const Matrix3d& soft_iron, const Vector3d& hard_iron_uT, double noise_uT, int readings = 2000,
              std::uint64_t seed = 2) {
  RandomStream random(seed, "turned");
  Turned result;
  for (int i = 0; i < readings; ++i) {
    const Quaterniond q_NB =
        Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian()).normalized();
    const Vector3d m_N = kField_uT * Vector3d(std::cos(kDip), 0, std::sin(kDip));
    const Vector3d noise(random.gaussian(noise_uT), random.gaussian(noise_uT), random.gaussian(noise_uT));
    result.raw_uT.push_back(soft_iron * (q_NB.conjugate() * m_N) + hard_iron_uT + noise);
    result.f_B.push_back(q_NB.conjugate() * Vector3d(0, 0, -kStandardGravity));
  }
  return result;
}

CompassCalibration example() {
  Matrix3d soft_iron;
  soft_iron << 1.03, 0.02, -0.01, 0.015, 0.97, 0.02, -0.02, 0.01, 1.01;
  const Turned t = turned(soft_iron, {12, -7, 20}, 0.1);
  return ellipsoid_compass(t.raw_uT, t.f_B);
}

TEST(CompassCalibration, EllipsoidFindsFieldDipAndOffsetWithinWhatItLeavesOpen) {
  const CompassCalibration c = example();
  EXPECT_NEAR(c.field_uT, kField_uT, 0.01 * kField_uT);  // its sensitivity is a convention
  EXPECT_NEAR(c.dip_rad, kDip, 0.05 * kDegree);
  EXPECT_LT((c.correction.offset - Vector3d(12, -7, 20)).norm(), 5 * c.left.hard_iron_sigma * kField_uT);
  EXPECT_NEAR(c.residual.relative_std, 0.1 / kField_uT, 0.2 * 0.1 / kField_uT);
}

// Both are relative to the field: what is left of the offset, and of the gain's six elements.
TEST(CompassCalibration, EllipsoidStatesWhatItLeavesOpenAsManySeedsFindIt) {
  const Vector3d hard_iron_uT(12, -7, 20);
  double offset = 0, gain = 0;
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Turned t = turned(Matrix3d::Identity(), hard_iron_uT, 0.3, 100, seed);
    const CompassCalibration c = ellipsoid_compass(t.raw_uT, t.f_B);
    const Vector3d off = (c.correction.offset - hard_iron_uT) / kField_uT;
    const Matrix3d uneven = kField_uT * c.correction.gain - Matrix3d::Identity();
    offset += off.squaredNorm() / 3 / std::pow(c.left.hard_iron_sigma, 2) / kSeeds;
    gain += uneven.diagonal().squaredNorm() / 3 / std::pow(c.left.soft_iron_sigma, 2) / kSeeds;
  }
  EXPECT_NEAR(std::sqrt(offset), 1, 0.3);
  EXPECT_NEAR(std::sqrt(gain), 1, 0.4);
}

TEST(CompassCalibration, MaxMinSaysThatItLeavesTheSoftIron) {
  Matrix3d soft_iron = Matrix3d::Identity();
  soft_iron(0, 1) = soft_iron(1, 0) = 0.05;
  const Turned t = turned(soft_iron, {3, 0, 0}, 0.05);
  const CompassCalibration max_min = max_min_compass(t.raw_uT, t.f_B),
                           fit = ellipsoid_compass(t.raw_uT, t.f_B);
  EXPECT_GT(max_min.left.soft_iron_sigma, 0.01);
  EXPECT_LT(fit.left.soft_iron_sigma, 1e-3);
}

TEST(CompassCalibration, StandsInTheCalibrationFileWhereThereIsOne) {
  SensorCalibration calibration;
  EXPECT_EQ(to_json(calibration).find("compass"), std::string::npos);
  EXPECT_FALSE(calibration_from_json(to_json(calibration), "a.json").compass);
  calibration.compass = example();
  const SensorCalibration read = calibration_from_json(to_json(calibration), "b.json");
  ASSERT_TRUE(read.compass);
  EXPECT_EQ(read.compass->method, "ellipsoid");
  EXPECT_LT((read.compass->correction.gain - calibration.compass->correction.gain).norm(), 1e-15);
  EXPECT_LT((read.compass->correction.offset - calibration.compass->correction.offset).norm(), 1e-12);
  EXPECT_NEAR(read.compass->left.hard_iron_sigma, calibration.compass->left.hard_iron_sigma, 1e-15);
}

TEST(CompassCalibration, IsRefusedWhereItIsNone) {
  SensorCalibration calibration;
  calibration.compass = example();
  calibration.compass->correction.gain *= 3;
  try {
    calibration_from_json(to_json(calibration), "c.json");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("c.json: /compass/gain_puT"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace waverig::estimator
