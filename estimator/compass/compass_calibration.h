// The calibration of a compass as it is kept: what the readings of all attitudes came to, and what it leaves
// open.
#pragma once
#include <string>

#include "estimator/compass/direction_budget.h"
#include "estimator/compass/magnetic_calibration.h"

namespace waverig::estimator {

// Of readings in uT by the data sheet's sensitivity.
struct CompassCalibration {
  std::string method;  // "ellipsoid", "max-min"
  MagneticCalibration
      correction;         // to a field of length 1 without the board's iron: gain in 1/uT, offset in uT
  double field_uT = 0;    // the field's strength where it was made, as that sensitivity has it
  double dip_rad = 0;     // and its dip
  NormResidual residual;  // how constant the norm came out
  CompassKnowledge left;  // what it leaves open, k = 1
};

// By Cho's max/min method, eq. (8). What it leaves open it cannot know: the norm's residual stands for it.
CompassCalibration max_min_compass(std::span<const Vector3d> raw_uT, std::span<const Vector3d> f_B);

// By the ellipsoid fit, turned until gravity and field agree on one dip; what it leaves open by the fit's
// covariance. f_B: specific force beside each reading.
CompassCalibration ellipsoid_compass(std::span<const Vector3d> raw_uT, std::span<const Vector3d> f_B);

}  // namespace waverig::estimator
