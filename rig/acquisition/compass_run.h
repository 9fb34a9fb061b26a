// Compass calibration run on the simulated rig: the sensor is turned through Cho's rotation procedure and
// once more, its frames go the real way through the acquisition, and both calibrations are made from the same
// readings.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/compass/compass_calibration.h"
#include "rig/acquisition/acquisition.h"
#include "rig/frontend/simulated_unit.h"

namespace waverig::rig {

struct CompassRunSettings {
  int steps = 36;                             // of each turn
  double settle_s = 0.5;                      // after each step, not used
  double record_s = 1;                        // at each step
  double fixture_sigma_rad = 0.03 * kDegree;  // of the turntable's angles, per axis
  double turntable_zero_rad = 0;              // where it points, true: the run finds north by itself
  Vector3d position_N_m = Vector3d::Zero();   // where the sensor is turned: the motor is near
  std::int64_t begin_utime = 0;
};

struct CompassRun {
  std::vector<Vector3d> raw_uT, f_B;  // means at each step, turn by turn
  double north_rad = 0;               // magnetic heading of the turntable's zero, as the level turn has it
  estimator::CompassCalibration max_min, ellipsoid;
  std::int64_t end_utime = 0;
};

// acquisition: with the accelerometer's calibration, without one of the compass. seed: of the fixture's
// errors and of the noise. Throws UserError where the readings make no calibration.
CompassRun turn_compass(const UnitSettings& settings, const UnitParameters& unit, Acquisition acquisition,
                        std::uint64_t seed, const CompassRunSettings& run = {});

// Root mean square heading error of a level turn in that field, for the report beside the simulated truth.
double level_heading_error_rad(const estimator::MagneticCalibration& calibration,
                               const MagnetometerParameters& unit, const EarthFieldSettings& earth);

// calibration_json with both calibrations beside each other and beside the simulated truth.
std::string with_compass_report(const std::string& calibration_json, const CompassRun& run,
                                const MagnetometerParameters& truth, const EarthFieldSettings& earth);

}  // namespace waverig::rig
