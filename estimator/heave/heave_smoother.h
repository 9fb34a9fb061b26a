// HeaveSmoother: heave of a whole record under a SeaModel, forward and backward at once.
//
// The model is the HeaveFilter's; over a record its most probable drift solves a banded least-squares problem
// in (d, d', b) at every node,
//     sum_k e(k)^2 / var e  +  sum_k |u(k+1) - F u(k)|^2 in Q^-1,       e(k) = z(k) - sum_j a_j z(k-j),
//     z = path - s . leaks - d
// whose first `order` innovations are those of the shorter predictors, so that the sea is stationary from the
// first node on: the record's ends are as much part of the model as its middle. Forward elimination and back
// substitution of the banded normal equations are the two passes (they equal Rauch-Tung-Striebel's); linear
// in time and memory. What a gyroscope wrong by the scale errors s leaks into the vertical (disturbance.h) is
// found with it, s being the same over the record.
//
// A body at rest (rests.h) stays where it is, at whatever level, and the sea after it knows nothing of what
// was before; where neither a rest's level stands out nor, of rests that agree on one, the mean of all, it is
// taken to lie at the sea's mean level, with the uncertainty of one that is not known. While the body is set
// in motion or brought to rest the sea is any sea, one slower than any wave included.
//
// Where that drift gains speed that noise does not give it, something else happened than the model says: the
// body was set in motion or brought to rest, and from one level to another, as no sea of that spectrum does;
// or the sensor's offset changed. Which one makes the minutes about it more probable is believed, and the
// record is gone through again with any sea there or with an offset that changes.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

struct SmoothedNode {
  double heave_m = 0;
  double heave_rate_mps = 0;
  double bias_mps2 = 0;
  double variance_m2 = 0;  // of heave
};

struct SensorDrift {             // what is known of it beforehand
  double accel_noise_m2ps3 = 0;  // two-sided density, data sheet
  double gyro_scale_sigma = 0;   // relative
};

// Nodes 0 … n for n increments; disturbance_m2ps3 is empty or one value an increment (as in
// HeaveFilter::step).
std::vector<SmoothedNode> smooth_heave(std::span<const LevelIncrement> increments, const SeaModel& model,
                                       const SensorDrift& sensor,
                                       std::span<const double> disturbance_m2ps3 = {});

}  // namespace waverig::estimator
