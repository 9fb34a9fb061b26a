#include "estimator/compass/magnetic_calibration.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "estimator/evaluation/sample_csv.h"
#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kField_uT = 50, kDip = 53 * kDegree;

// raw = soft m + hard: what iron and a real part make of the field.
struct Distortion {
  Matrix3d soft = Matrix3d::Identity();
  Vector3d hard_uT = Vector3d::Zero();
  double noise_uT = 0;
};

Distortion strong_iron() {
  Distortion d;
  d.soft << 1.10, 0.05, -0.03, 0.05, 0.93, 0.04, -0.03, 0.04, 1.02;
  d.hard_uT = {25, -40, 12};
  return d;
}

Quaterniond random_attitude(RandomStream& random) {
  return Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian()).normalized();
}

Vector3d true_field_B(const Quaterniond& q_NB) {
  return kField_uT * (q_NB.conjugate() * Vector3d(std::cos(kDip), 0, std::sin(kDip)));
}

Vector3d reading(const Quaterniond& q_NB, const Distortion& d, RandomStream& random) {
  const Vector3d noise(random.gaussian(d.noise_uT), random.gaussian(d.noise_uT), random.gaussian(d.noise_uT));
  return d.soft * true_field_B(q_NB) + d.hard_uT + noise;
}

std::vector<Vector3d> readings(const std::vector<Quaterniond>& attitudes, const Distortion& d,
                               RandomStream& random) {
  std::vector<Vector3d> raw;
  for (const Quaterniond& q : attitudes) raw.push_back(reading(q, d, random));
  return raw;
}

std::vector<Quaterniond> random_attitudes(int n, RandomStream& random) {
  std::vector<Quaterniond> attitudes;
  for (int i = 0; i < n; ++i) attitudes.push_back(random_attitude(random));
  return attitudes;
}

double worst_heading_error(const MagneticCalibration& calibration, const Distortion& distortion) {
  double worst = 0;
  for (double psi = -3; psi < 3; psi += 0.1)
    for (const Tilt tilt : {Tilt{0, 0}, Tilt{0.3, -0.2}, Tilt{-0.4, 0.3}}) {
      const Quaterniond q = quaternion_of({tilt.roll_rad, tilt.pitch_rad, psi});
      const Vector3d m_B = calibration.apply(distortion.soft * true_field_B(q) + distortion.hard_uT);
      worst = std::max(worst, std::abs(std::remainder(heading_rad(m_B, tilt) - psi, 2 * std::numbers::pi)));
    }
  return worst;
}

// The turntable's zero points 1.1 rad off north; the procedure finds north by itself.
std::vector<Vector3d> run_procedure(const Distortion& d, RandomStream& random) {
  const Quaterniond table = quaternion_of({0, 0, 1.1});
  const auto turned = [&](std::vector<Quaterniond> attitudes) {
    for (Quaterniond& q : attitudes) q = table * q;
    return readings(attitudes, d, random);
  };
  std::vector<Vector3d> raw = turned(level_turn(72));
  const double north = north_from_level_turn(raw);
  for (const auto& turn : {turned(pitch_turn(north, 360)), turned(roll_turn(north, 360))})
    raw.insert(raw.end(), turn.begin(), turn.end());
  return raw;
}

TEST(MaxMinCalibration, RecoversOffsetAndScaleByTheRotationProcedure) {
  Distortion d;
  d.soft.diagonal() << 1.2, 0.8, 1.05;
  d.hard_uT = {30, -20, 5};
  RandomStream random(1, "magnetic");
  const MagneticCalibration calibration = max_min_calibration(run_procedure(d, random));
  EXPECT_LT((calibration.offset - d.hard_uT).norm(), 0.01 * kField_uT);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(calibration.gain(i, i) * d.soft(i, i) * kField_uT, 1, 1e-3);
  EXPECT_LT(worst_heading_error(calibration, d), 1 * kDegree);
}

TEST(MaxMinCalibration, NeedsTheDipToBeVisited) {
  Distortion d;
  d.hard_uT = {30, -20, 5};
  RandomStream random(2, "magnetic");
  const MagneticCalibration level_only =
      max_min_calibration(readings(level_turn(360), {.noise_uT = 0.01}, random));
  // Turned level only, x and y reach cos(dip) of the field: taken for the whole, they are 1 / cos(dip) too
  // long.
  EXPECT_NEAR(level_only.gain(0, 0) * kField_uT, 1 / std::cos(kDip), 0.01);
}

TEST(RotationProcedure, FindsNorthFromTheLevelTurn) {
  RandomStream random(3, "magnetic");
  std::vector<Quaterniond> attitudes = level_turn(72);
  for (Quaterniond& q : attitudes) q = quaternion_of({0, 0, -0.7}) * q;
  Distortion d;
  d.hard_uT = {30, -20, 5};
  EXPECT_NEAR(north_from_level_turn(readings(attitudes, d, random)), -0.7, 1e-12);
}

TEST(EllipsoidCalibration, RecoversFullSoftIronWhereMaxMinCannot) {
  const Distortion d = strong_iron();
  RandomStream random(4, "magnetic");
  const std::vector<Vector3d> raw = readings(random_attitudes(400, random), d, random);
  const EllipsoidFit fit = ellipsoid_calibration(raw);
  EXPECT_LT((fit.calibration.offset - d.hard_uT).norm(), 1e-8 * kField_uT);
  EXPECT_LT(fit.residual.relative_std, 1e-9);
  const Matrix3d undone = fit.calibration.gain * d.soft * kField_uT;  // soft is symmetric: nothing is left
  EXPECT_LT((undone - Matrix3d::Identity()).norm(), 1e-8);
  EXPECT_LT(worst_heading_error(fit.calibration, d), 1e-6);
  const NormResidual rough = norm_residual(raw, max_min_calibration(raw));
  EXPECT_GT(rough.relative_std, 0.01);
}

TEST(EllipsoidCalibration, IsUnbiasedAndKnowsItsUncertainty) {
  const Distortion d = [] {
    Distortion iron = strong_iron();
    iron.noise_uT = 0.5;
    return iron;
  }();
  Vector3d mean_error = Vector3d::Zero(), mean_square = Vector3d::Zero(), stated = Vector3d::Zero();
  const int seeds = 60;
  for (int seed = 0; seed < seeds; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "magnetic");
    const EllipsoidFit fit = ellipsoid_calibration(readings(random_attitudes(300, random), d, random));
    const Vector3d error = fit.calibration.offset - d.hard_uT;
    mean_error += error / seeds;
    mean_square += error.cwiseAbs2() / seeds;
    stated += fit.covariance.diagonal().tail<3>() / seeds;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(mean_error[i]), 4 * std::sqrt(stated[i] / seeds));
    EXPECT_NEAR(mean_square[i] / stated[i], 1, 0.6);  // 60 seeds: 18 % standard deviation
  }
}

TEST(EllipsoidCalibration, ShrugsOffASpike) {
  Distortion d = strong_iron();
  d.noise_uT = 0.2;
  RandomStream random(5, "magnetic");
  std::vector<Vector3d> raw = readings(random_attitudes(500, random), d, random);
  raw[17] += Vector3d(300, 0, 0);
  raw[230] += Vector3d(0, -200, 100);
  const EllipsoidFit fit = ellipsoid_calibration(raw);
  EXPECT_LT((fit.calibration.offset - d.hard_uT).norm(), 0.3);
}

TEST(EllipsoidCalibration, RefusesAPlaneAndTooFewReadings) {
  RandomStream random(6, "magnetic");
  const std::vector<Vector3d> flat = readings(level_turn(100), strong_iron(), random);
  EXPECT_THROW(ellipsoid_calibration(flat), UserError);
  EXPECT_THROW(ellipsoid_calibration(std::span(flat).first(5)), UserError);
  EXPECT_THROW(max_min_calibration({}), UserError);
  const std::vector<Vector3d> same(50, Vector3d(1, 2, 3));
  EXPECT_THROW(ellipsoid_calibration(same), UserError);
  EXPECT_THROW(max_min_calibration(same), UserError);
}

TEST(AlignmentWithGravity, FindsTheRotationThatTheNormHides) {
  Distortion d = strong_iron();
  const Vector3d turn(0.05, -0.08, 0.06);  // a magnetometer turned on its board
  d.soft = quaternion_exp(turn).toRotationMatrix() * d.soft;
  RandomStream random(7, "magnetic");
  const std::vector<Quaterniond> attitudes = random_attitudes(400, random);
  const std::vector<Vector3d> raw = readings(attitudes, d, random);
  std::vector<Vector3d> f_B;
  for (const Quaterniond& q : attitudes) f_B.push_back(q.conjugate() * Vector3d(0, 0, -kStandardGravity));
  const EllipsoidFit fit = ellipsoid_calibration(raw);
  EXPECT_GT(worst_heading_error(fit.calibration, d), 2 * kDegree);
  const Alignment aligned = align_with_gravity(fit.calibration, raw, f_B);
  EXPECT_NEAR(aligned.dip_rad, kDip, 1e-7);
  EXPECT_LT(aligned.dip_std_rad, 1e-7);
  EXPECT_LT(worst_heading_error(aligned.calibration, d), 1e-6);
}

std::filesystem::path recordings() {
  if (const char* folder = std::getenv("WAVERIG_DATA")) return folder;
  return std::filesystem::path(WAVERIG_SOURCE_DIR).parent_path() / "shared/data";
}

// A real magnetometer turned by hand through all attitudes (BROAD trial 1): the norm must come out constant.
TEST(EllipsoidCalibration, MakesTheNormOfARealMagnetometerConstant) {
  const auto file = recordings() / "broad01_rotation.csv.gz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recording " << file;
  evaluation::SampleCsvReader reader(file);
  ImuSample sample;
  std::vector<Vector3d> resting, turning;  // before it is taken up, and in the hand
  while (reader.next(sample)) {
    if (sample.w_NB_B.norm() > 0.3)
      turning.push_back(sample.m_B_uT);
    else if (turning.empty())
      resting.push_back(sample.m_B_uT);
  }
  const double noise = norm_residual(resting, {}).relative_std;
  const double before = norm_residual(turning, {}).relative_std;
  const double max_min = norm_residual(turning, max_min_calibration(turning)).relative_std;
  const double ellipsoid = ellipsoid_calibration(turning).residual.relative_std;
  std::printf(
      "standard deviation of the norm: raw %.2f %%, max/min %.2f %%, ellipsoid %.2f %%, noise at rest %.2f "
      "%%\n",
      100 * before, 100 * max_min, 100 * ellipsoid, 100 * noise);
  EXPECT_LT(ellipsoid, max_min);
  EXPECT_LT(ellipsoid, 0.9 * before);
  EXPECT_LT(std::sqrt(ellipsoid * ellipsoid - noise * noise), 0.008);  // besides the part's own noise
}

}  // namespace
}  // namespace waverig::estimator
