// HeaveSmoother: heave of a whole record under a SeaModel, forward and backward at once.
//
// The model is the HeaveFilter's; over a record its most probable drift solves a banded least-squares problem
// in (d, d', b) at every node,
//     sum_k e(k)^2 / var e  +  sum_k |u(k+1) - F u(k)|^2 in Q^-1,       e(k) = z(k) - sum_j a_j z(k-j),  z =
//     path - d
// whose first `order` innovations are those of the shorter predictors, so that the sea is stationary from the
// first node on: the record's ends are as much part of the model as its middle. Forward elimination and back
// substitution of the banded normal equations are the two passes (they equal Rauch-Tung-Striebel's); linear
// in time and memory.
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

// Nodes 0 … n for n increments; disturbance_m2ps3 is empty or one value an increment (as in
// HeaveFilter::step).
std::vector<SmoothedNode> smooth_heave(std::span<const PathIncrement> increments, const SeaModel& model,
                                       std::span<const double> disturbance_m2ps3 = {});

}  // namespace waverig::estimator
