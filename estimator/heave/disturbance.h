// What sensor calibration and attitude leave in vertical acceleration and heave; shared by the methods.
#pragma once
#include "estimator/attitude/attitude_filter.h"
#include "estimator/heave/sea_model.h"
#include "estimator/method.h"

namespace waverig::estimator {

AttitudeSettings attitude_settings(const SensorKnowledge& sensor);
double accel_noise_m2ps3(const SensorKnowledge& sensor);  // two-sided density, data sheet

// How the body moves and what its sensor is worth, followed sample by sample.
struct Motion {
  double tilt_variance_rad2 = 0;       // of the attitude's error
  double leaning_variance_rad2 = 0;    // of the body itself, both axes, about its mean
  Vector3d down_B = Vector3d::Zero();  // mean direction of the plumb line
  double excess_mps2 = 0;  // mean vertical acceleration: what the calibration can be seen to leave

  // share: of this sample in the fading mean, 1 at first.
  void follow(const AttitudeSample& attitude, double share);
};

// Two-sided densities of white vertical acceleration, m^2/s^3, by which a sample is worse than the sensor's
// noise. A tilt error of the stated size lets in horizontal acceleration to first and gravity to second
// order, g tilt^2 / 2; a saturated sample says little.
double disturbance_m2ps3(const AttitudeSample& attitude, std::int32_t flags, double gravity_mps2);
// An offset is turned over as the body leans away from its mean. For as long as no record shows the noise
// that makes.
double turned_offset_m2ps3(const AttitudeSample& attitude, const Motion& motion,
                           const SensorKnowledge& sensor);

// What the vertical acceleration, up, errs by per unit of a relative scale error of the gyroscope about body
// x and y: the attitude errs in proportion to the angle phi by which the body leans from its mean, since what
// is slow is levelled, and  a = -down . (phi_i e_i x f).
Eigen::Array2d gyro_scale_leaks_mps2(const AttitudeSample& attitude, const Motion& motion,
                                     const Vector3d& f_B);

struct MeanDisturbance {
  double sum_m2ps3 = 0, gap_m2ps3 = 0;
  int count = 0;
  void add(double density_m2ps3) {
    sum_m2ps3 += density_m2ps3;
    ++count;
  }
  // The samples of this interval left out what may have changed the speed by so much.
  void add_gap(double speed_mps, double interval_s) { gap_m2ps3 += speed_mps * speed_mps / interval_s; }
  double mean() const { return (count > 0 ? sum_m2ps3 / count : 0.0) + gap_m2ps3; }
};

// Standard uncertainty of the mean vertical acceleration, by what calibration and gravity leave.
double offset_sigma_mps2(const SensorKnowledge& sensor);
// The same after motion.excess_mps2 was found in a sea's elapsed_s: the excess, where they cannot have left
// it.
double offset_sigma_mps2(const Motion& motion, const SeaModel& sea, double elapsed_s,
                         const SensorKnowledge& sensor);

// Variance of heave by calibration and attitude: scale; tilt error times horizontal path, which is about as
// wide as heave is high; offset and misalignment of the sensor as the body leans over.
double systematic_variance_m2(const SeaModel& sea, const Motion& motion, const SensorKnowledge& sensor);

}  // namespace waverig::estimator
