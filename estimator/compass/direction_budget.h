// How far a direction is off where the compass is.
#pragma once

namespace waverig::estimator {

// What a compass that is not perfect does to a direction, first order, averaged over headings; standard
// uncertainties.
struct CompassKnowledge {
  double hard_iron_sigma = 0;  // left after calibration, per axis, of the total field
  double soft_iron_sigma = 0;  // per element of the matrix
  double tilt_sigma_rad = 0;   // constant over the record, per axis
  double declination_sigma_rad = 0;
  // Of the gyroscope's axes against the accelerometer's. A body that follows the apparent vertical, a gondola
  // or a buoy, shows its accelerometer no horizontal force: that of the waves is gravity times a tilt that
  // the gyroscope alone has seen, and turns with its axes, one to one.
  double gyro_misalignment_sigma_rad = 0;
};
struct DirectionBudget {
  double hard_iron_rad = 0, soft_iron_rad = 0, tilt_rad = 0, declination_rad = 0, gyro_rad = 0;
  double total_rad() const;
};
DirectionBudget direction_budget(const CompassKnowledge& knowledge, double dip_rad);

}  // namespace waverig::estimator
