#include "estimator/calibration/six_position.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kG = kStandardGravity;

AccelerometerCalibration published_unit() {
  AccelerometerCalibration c;
  c.M << 1.0074, -0.0022, 0.0039, -0.0065, 0.9856, 0.0138, -0.0027, 0.0087, 0.9963;
  c.b_mps2 = Vector3d(-0.0354, 0.0081, 0.0041) * kG;
  return c;
}

Vector3d gaussian(RandomStream& random, double sigma) {
  return {random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma)};
}

// Readings of the six positions, with noise on each mean and a fixture that misses.
std::array<PositionReading, 6> readings_of(const AccelerometerCalibration& unit, double noise, double miss,
                                           RandomStream& random) {
  std::array<PositionReading, 6> readings;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3d f = (k % 2 == 0 ? kG : -kG) * Vector3d::Unit(static_cast<int>(k / 2));
    const Vector3d felt = quaternion_exp(gaussian(random, miss)).conjugate() * f;
    readings[k] = {f, unit.reading(felt) + gaussian(random, noise), Matrix3d::Identity() * noise * noise};
  }
  return readings;
}

double largest_error(const AccelerometerCalibration& found, const AccelerometerCalibration& truth) {
  return std::max({(found.M - truth.M).cwiseAbs().maxCoeff(),
                   (found.b_mps2 - truth.b_mps2).cwiseAbs().maxCoeff(),
                   (found.quadratic_pmps2 - truth.quadratic_pmps2).cwiseAbs().maxCoeff()});
}

TEST(SixPositions, RecoverThePublishedUnitExactlyWithoutNoise) {
  RandomStream random(1, "none");
  const SixPositionFit fit = fit_six_positions(readings_of(published_unit(), 0, 0, random), 0);
  EXPECT_LT(largest_error(fit.calibration, published_unit()), 1e-12);
  EXPECT_LT(fit.residual_rms_mps2, 1e-12);
}

AccelerometerCalibration bent_unit() {
  AccelerometerCalibration c = published_unit();
  c.quadratic_pmps2 = Vector3d(2e-3, -5e-3, 3e-3) / kG;
  return c;
}

TEST(SixPositions, RecoverABentUnitExactlyWithoutNoise) {
  RandomStream random(1, "none");
  const SixPositionFit fit =
      fit_six_positions(readings_of(bent_unit(), 0, 0, random), 0, SixPositionModel::kBent);
  EXPECT_LT(largest_error(fit.calibration, bent_unit()), 1e-10);
  EXPECT_LT(fit.residual_rms_mps2, 1e-10);
  EXPECT_EQ(fit.degrees_of_freedom, 3);
}

TEST(SixPositions, RecoverUnitsWithinTheirOwnCovarianceOverManySeeds) {
  constexpr double kNoise = 2e-3, kMiss = 0.05 * kDegree;
  constexpr int kRuns = 1500;
  for (const SixPositionModel model : {SixPositionModel::kLinear, SixPositionModel::kBent}) {
    const bool bent = model == SixPositionModel::kBent;
    const AccelerometerCalibration unit = bent ? bent_unit() : published_unit();
    const int unknowns = bent ? 15 : 12;
    double chi_sum = 0, residual_sum = 0;
    int covered = 0;
    for (int run = 0; run < kRuns; ++run) {
      RandomStream random(static_cast<std::uint64_t>(run), "six positions");
      const SixPositionFit fit = fit_six_positions(readings_of(unit, kNoise, kMiss, random), kMiss, model);
      const CalibrationError error = error_against(fit.calibration, unit);
      ASSERT_EQ(error.degrees_of_freedom, unknowns);
      chi_sum += error.chi_square;
      residual_sum += fit.chi_square;
      for (int i = 0; i < unknowns; ++i) covered += std::abs(error.over_sigma[i]) <= 2;
    }
    // Means of chi-square variables, within four standard errors.
    EXPECT_NEAR(chi_sum / kRuns, unknowns, 4 * std::sqrt(2.0 * unknowns / kRuns));
    EXPECT_NEAR(residual_sum / kRuns, 18 - unknowns, 4 * std::sqrt(2.0 * (18 - unknowns) / kRuns));
    EXPECT_NEAR(covered / (1.0 * unknowns * kRuns), 0.9545, 0.01);
  }
}

TEST(SixPositions, SeeABentCharacteristicInTheirResiduals) {
  RandomStream random(3, "bent");
  auto readings = readings_of(published_unit(), 1e-3, 0, random);
  for (auto& reading : readings)
    reading.mean_mps2 += 2e-3 * reading.mean_mps2.cwiseAbs2() / kG;  // 0.2 % of g at g
  EXPECT_GT(fit_six_positions(readings, 0).chi_square, 25);          // 0.999 quantile of 6 degrees: 22.5
}

TEST(SixPositions, RefuseAPositionTakenTwice) {
  RandomStream random(4, "twice");
  auto readings = readings_of(published_unit(), 0, 0, random);
  for (std::size_t k : {2U, 3U}) readings[k] = readings[0];
  EXPECT_THROW(fit_six_positions(readings, 0), UserError);
}

TEST(PositionRecorder, StatesTheMeanOfCorrelatedSamplesHonestly) {
  // Samples that move together for a second: sigma / sqrt(n) of single samples would be ten times too small.
  constexpr int kRuns = 400, kSeconds = 60, kRate = 100;
  double squares = 0, stated = 0;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "recorder");
    PositionRecorder recorder(3 * kRate);
    for (int second = 0; second < kSeconds; ++second) {
      const Vector3d level(1 + random.gaussian(), 0, 0);
      for (int n = 0; n < kRate; ++n) recorder.add(level);
    }
    squares += std::pow(recorder.mean().x() - 1, 2);
    stated += recorder.mean_covariance()(0, 0);
  }
  EXPECT_NEAR(squares / stated, 1, 0.25);
  EXPECT_NEAR(stated / kRuns, 1.0 / kSeconds, 0.15 / kSeconds);
}

}  // namespace
}  // namespace waverig::estimator
