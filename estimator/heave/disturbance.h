// What sensor calibration and attitude leave in vertical acceleration and heave; shared by the methods.
#pragma once
#include "estimator/attitude/attitude_filter.h"
#include "estimator/heave/sea_model.h"
#include "estimator/method.h"

namespace waverig::estimator {

AttitudeSettings attitude_settings(const SensorKnowledge& sensor);

// Two-sided density of white vertical acceleration, m^2/s^3, by which this sample is worse than the sensor's
// noise: a tilt error of the stated size lets in horizontal acceleration to first and gravity to second
// order; a saturated sample says little.
double disturbance_m2ps3(const AttitudeSample& attitude, std::int32_t flags, double gravity_mps2);

// How the body has moved, for the part of the uncertainty that is in proportion to it.
struct Motion {
  double tilt_variance_rad2 = 0;     // of the attitude's error
  double leaning_variance_rad2 = 0;  // of the body itself, both axes
};

// Variance of heave by calibration and attitude: scale; tilt error times horizontal path, which is about as
// wide as heave is high; offset and misalignment of the sensor as the body leans over.
double systematic_variance_m2(const SeaModel& sea, const Motion& motion, const SensorKnowledge& sensor);

}  // namespace waverig::estimator
