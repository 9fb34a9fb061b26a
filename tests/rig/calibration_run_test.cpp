#include "rig/acquisition/calibration_run.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

constexpr double kG = kStandardGravity;

CalibrationRunSettings quick() {
  CalibrationRunSettings run;
  run.settle_s = 0.1;
  run.record_s = 4;
  run.batch_s = 0.2;
  return run;
}

TEST(CalibrationRun, FindsThePublishedUnitThroughTheCounts) {
  UnitSettings s = ideal_unit();
  UnitParameters unit = draw_unit(s, 1);
  unit.accelerometer = lee2014_accelerometer();
  CalibrationRunSettings run = quick();
  run.fixture_sigma_rad = 0;
  const CalibrationRun result = run_six_positions(s, unit, nominal_sensitivities(s), kG, 1, run);
  // No noise: what is left is the quantum, spread over the record.
  EXPECT_LT((result.calibration.accelerometer.M - unit.accelerometer.M).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((result.calibration.accelerometer.b_mps2 - unit.accelerometer.bias_mps2).cwiseAbs().maxCoeff(),
            1e-4);
  EXPECT_EQ(result.end_utime, 6 * 4'100'000);
}

// Noise and a missing fixture, but nothing that the linear model does not know.
UnitSettings linear_unit() {
  UnitSettings s = datasheet_unit();
  s.accelerometer.nonlinearity_sigma = 0;
  s.accelerometer.instability_sigma_mps2 = 0;
  s.front_end.scale_sigma = 0;
  s.temperature = {};
  return s;
}

TEST(CalibrationRun, RecoversUnitsWithinItsOwnCovarianceOverManySeeds) {
  CalibrationRunSettings linear = quick();
  linear.model = estimator::SixPositionModel::kLinear;
  const UnitSettings s = linear_unit();
  const Sensitivities nominal = nominal_sensitivities(s);
  constexpr int kRuns = 150;
  double chi = 0, residual = 0;
  int covered = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const UnitParameters unit = draw_unit(s, seed);
    const CalibrationRun run =
        run_six_positions(s, unit, nominal, kG, derived_seed(seed, "calibration"), linear);
    const auto& found = run.calibration.accelerometer;
    const auto truth = true_calibration(s, unit, nominal, run.calibration.temperature_degC,
                                        estimator::SixPositionModel::kLinear);
    const estimator::CalibrationError error = error_against(found, truth);
    EXPECT_EQ(error.degrees_of_freedom, 12);
    chi += error.chi_square / kRuns;
    residual += run.calibration.chi_square / kRuns;
    for (int i = 0; i < 12; ++i) covered += std::abs(error.over_sigma[i]) <= 2;
  }
  // Covariances from 20 batches are themselves scattered, which widens chi-square by about 19/16.
  EXPECT_NEAR(chi, 13, 2.5);
  EXPECT_NEAR(residual, 6.5, 1.5);
  EXPECT_NEAR(covered / (12.0 * kRuns), 0.95, 0.02);
}

TEST(CalibrationRun, StatesWhatDriftsFromPositionToPosition) {
  UnitSettings s = datasheet_unit();  // with instability and a warming unit, both over the run's minutes
  s.temperature.warm_up_degC = 5;
  const Sensitivities nominal = nominal_sensitivities(s);
  CalibrationRunSettings run = quick();
  run.settle_s = 10;
  constexpr int kRuns = 60;
  double chi = 0;
  int covered = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const UnitParameters unit = draw_unit(s, seed);
    const CalibrationRun found = run_six_positions(s, unit, nominal, kG, derived_seed(seed, "drift"), run);
    const auto truth = true_calibration(s, unit, nominal, found.calibration.temperature_degC);
    const estimator::CalibrationError error = error_against(found.calibration.accelerometer, truth);
    chi += error.chi_square / (15 * kRuns);
    for (int i = 0; i < 15; ++i) covered += std::abs(error.over_sigma[i]) <= 2;
  }
  EXPECT_LT(chi, 2);
  EXPECT_GT(covered / (15.0 * kRuns), 0.9);
}

TEST(CalibrationRun, TruthIsWhatAPerfectRunFinds) {
  UnitSettings s = datasheet_unit();  // with bend, uneven reset currents, clocks and warmth
  s.temperature = {.mean_degC = 31};
  const UnitParameters unit = draw_unit(s, 7);
  const Sensitivities nominal = nominal_sensitivities(s);
  UnitSettings quiet = s;
  quiet.accelerometer.noise_density_mps2 = quiet.accelerometer.instability_sigma_mps2 = 0;
  CalibrationRunSettings run = quick();
  run.fixture_sigma_rad = 0;
  run.record_s = 20;
  const CalibrationRun found = run_six_positions(quiet, unit, nominal, kG, 1, run);
  const auto truth = true_calibration(quiet, unit, nominal, 31);
  EXPECT_LT((found.calibration.accelerometer.M - truth.M).cwiseAbs().maxCoeff(), 3e-6);
  EXPECT_LT((found.calibration.accelerometer.b_mps2 - truth.b_mps2).cwiseAbs().maxCoeff(), 3e-5);
  EXPECT_LT((found.calibration.accelerometer.quadratic_pmps2 - truth.quadratic_pmps2).cwiseAbs().maxCoeff(),
            1e-6);
}

// How far a calibrated unit's scale on the level is off for small movements about rest, which is what a wave
// asks.
double scale_error_on_the_level(const UnitSettings& s, const UnitParameters& unit,
                                const estimator::AccelerometerCalibration& calibration) {
  const auto corrected = [&](double up_mps2) {
    SimulatedUnit sensor(s, unit, 1);
    Acquisition acquisition(nominal_sensitivities(s));
    acquisition.apply(calibration, {});
    std::vector<std::uint8_t> bytes;
    BodyMotion m;
    m.acceleration_N.z() = -up_mps2;
    sensor.step(m, 0, bytes);
    for (int k = 0; k < 5000; ++k) sensor.step(m, 2e-3, bytes);
    double sum = 0, samples = 0;
    acquisition.add(bytes, [&](const UnitCounts&, const estimator::ImuSample& sample) {
      sum -= sample.f_B.z();
      ++samples;
    });
    return sum / samples;
  };
  return (corrected(0.5) - corrected(-0.5)) - 1;
}

TEST(CalibrationRun, TheBentModelLeavesLessOfTheScaleOnTheLevelAndBothStateIt) {
  UnitSettings s = datasheet_unit();
  UnitSettings quiet = s;
  quiet.accelerometer.noise_density_mps2 = quiet.accelerometer.instability_sigma_mps2 = 0;
  CalibrationRunSettings run = quick();
  run.record_s = 20;
  run.batch_s = 2;
  double linear = 0, bent = 0, stated_linear = 0, stated_bent = 0;
  constexpr int kUnits = 40;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const UnitParameters unit = draw_unit(s, seed);
    const CalibrationRun found = run_six_positions(s, unit, nominal_sensitivities(s), kG, seed, run);
    linear += std::pow(scale_error_on_the_level(quiet, unit, found.linear_fit.calibration), 2) / kUnits;
    bent += std::pow(scale_error_on_the_level(quiet, unit, found.fit.calibration), 2) / kUnits;
    stated_linear += std::pow(slope_sigma(s, found.linear_fit.calibration), 2) / kUnits;
    stated_bent += std::pow(slope_sigma(s, found.fit.calibration), 2) / kUnits;
  }
  RecordProperty("linear_ppm", static_cast<int>(1e6 * std::sqrt(linear)));
  RecordProperty("bent_ppm", static_cast<int>(1e6 * std::sqrt(bent)));
  EXPECT_LT(std::sqrt(bent), 0.0015);
  EXPECT_LT(bent, 0.5 * linear);
  // As wide as stated: standard deviations of 40 units scatter by 11 %.
  EXPECT_NEAR(std::sqrt(linear / stated_linear), 1, 0.3);
  EXPECT_NEAR(std::sqrt(bent / stated_bent), 1, 0.3);
}

TEST(CalibrationRun, AWrongGravityShowsAsScale) {
  UnitSettings s = ideal_unit();
  CalibrationRunSettings run = quick();
  run.fixture_sigma_rad = 0;
  const CalibrationRun result =
      run_six_positions(s, draw_unit(s, 1), nominal_sensitivities(s), kG * 1.001, 1, run);
  EXPECT_NEAR(result.calibration.accelerometer.M(2, 2), 1 / 1.001, 1e-5);
}

TEST(CalibrationRun, FindsTheGyroscopesZero) {
  const UnitSettings s = linear_unit();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    UnitParameters unit = draw_unit(s, seed);
    const CalibrationRun run = run_six_positions(s, unit, nominal_sensitivities(s), kG, seed, quick());
    const Vector3d error = run.calibration.gyroscope.offset_radps - unit.gyroscope.offset_radps;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.02 * kDegree);
    EXPECT_LT(error.cwiseQuotient(run.calibration.gyroscope.offset_sigma_radps).cwiseAbs().maxCoeff(), 6);
  }
}

TEST(CalibrationRun, ReportPutsTheTruthBesideTheResult) {
  const UnitSettings s = datasheet_unit();
  const UnitParameters unit = draw_unit(s, 2);
  const Sensitivities nominal = nominal_sensitivities(s);
  const CalibrationRun run = run_six_positions(s, unit, nominal, kG, 1, quick());
  const auto truth = true_calibration(s, unit, nominal, run.calibration.temperature_degC);
  const auto report = nlohmann::json::parse(calibration_report(run, truth));
  EXPECT_EQ(report["simulated_truth"]["M"][1][2].get<double>(), truth.M(1, 2));
  EXPECT_EQ(report["accelerometer"]["M"][1][2].get<double>(), run.calibration.accelerometer.M(1, 2));
  EXPECT_EQ(report["positions"].size(), 6U);
  EXPECT_EQ(report["positions"][4]["name"], "z up");
}

TEST(CalibrationRun, RefusesARecordTooShortForItsBatches) {
  CalibrationRunSettings run = quick();
  run.record_s = 0.3;
  const UnitSettings s = ideal_unit();
  EXPECT_THROW(run_six_positions(s, draw_unit(s, 1), nominal_sensitivities(s), kG, 1, run), UserError);
}

}  // namespace
}  // namespace waverig::rig
