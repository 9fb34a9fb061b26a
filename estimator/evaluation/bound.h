// The physical limit of a single wave's height: the Cramer-Rao bound of REFERENCE section 3.
#pragma once
#include "estimator/types.h"

namespace waverig::evaluation {

// What is known of one wave's record: levelled vertical acceleration
//   a(t) = -w^2 (P cos w t + Q sin w t) + c0 + c1 t + n(t),   H = 2 hypot(P, Q),   t from the wave's start,
// n white with the one-sided amplitude density `noise_density`.
struct BoundSettings {
  double period_s = 0;
  double noise_density_mps2_rthz = estimator::kUnknown;
  double sample_rate_hz = 0;
  double crest_phase_rad = 0;  // phase of the crest at the record's start; 0: from crest to crest, Lee 2014
};

// Standard deviation that no unbiased estimator of H from one whole wave can undercut, from the inverse of
// the Fisher matrix of (P, Q, c0, c1) over the samples of that wave. NaN where the noise is unknown or the
// wave has fewer than five samples. From crest to crest the drift c1 is orthogonal to the height; from any
// other phase it costs. Sampled densely from crest to crest it is (2 / w^2) nd / sqrt(T).
double height_bound_m(const BoundSettings& settings);

}  // namespace waverig::evaluation
