// Six-position calibration run on the simulated rig: the sensor is turned through the six positions, its
// frames go the real way through the acquisition, and the fit is made from the readings alone.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "estimator/calibration/six_position.h"
#include "rig/acquisition/acquisition.h"
#include "rig/frontend/simulated_unit.h"

namespace waverig::rig {

struct CalibrationRunSettings {
  double settle_s = 2;   // after each turn, not used
  double record_s = 30;  // in each position
  double batch_s = 3;
  double fixture_sigma_rad = 0.03 * kDegree;  // standard uncertainty of the fixture's angles
  double step_s = 2e-3;                       // of the simulation
  std::int64_t begin_utime = 0;
  std::string sensor_id = "simulated";
  estimator::SixPositionModel model = estimator::SixPositionModel::kBent;
  std::optional<FrontEndChoice> front_end;  // applied to the readings, as it will be in use
};

struct CalibrationRun {
  estimator::SensorCalibration calibration;
  estimator::SixPositionFit fit;         // what the calibration holds
  estimator::SixPositionFit linear_fit;  // the document's 12 unknowns, from the same readings
  std::array<estimator::PositionReading, 6> readings;
  std::int64_t end_utime = 0;
};

// seed: of the fixture's errors and of the noise. gravity_mps2: what the laboratory takes gravity to be (a
// wrong one shows as scale).
CalibrationRun run_six_positions(const UnitSettings& settings, const UnitParameters& unit,
                                 const Sensitivities& sensitivities, double gravity_mps2, std::uint64_t seed,
                                 const CalibrationRunSettings& run = {});

// What the six positions should find: the same fit from perfect readings of the whole chain, front end
// included, at one temperature. For the report beside the calibration, never for a correction.
estimator::AccelerometerCalibration true_calibration(
    const UnitSettings& settings, const UnitParameters& unit, const Sensitivities& sensitivities,
    double temperature_degC, estimator::SixPositionModel model = estimator::SixPositionModel::kBent,
    const std::optional<FrontEndChoice>& front_end = std::nullopt);

// What such a calibration leaves open of the scale for small movements about 1 g, relative, k = 1: the cubic
// part of the bend, that of the quadratic one as the fit knows it (or all of it, where the fit is linear),
// and the unevenness of the reset currents. From the data sheet's scatter, not from the unit.
double slope_sigma(const UnitSettings& settings, const estimator::AccelerometerCalibration& calibration);

// The calibration file's JSON with the simulated truth and the normalised errors beside it.
std::string calibration_report(const CalibrationRun& run, const estimator::AccelerometerCalibration& truth);

}  // namespace waverig::rig
