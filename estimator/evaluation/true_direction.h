// Where the waves of a record really came from, from the truth's own heave, north and east motion: what a
// perfect compass and perfect sensors would have told of the same record.
#pragma once
#include <cstdint>

#include "estimator/evaluation/truth_series.h"

namespace waverig::evaluation {

struct TrueDirection {
  double mean_direction_rad = estimator::kUnknown;  // from, true, [0, 2 pi)
  double spread_rad = estimator::kUnknown;
  double check_factor = estimator::kUnknown;  // horizontal over vertical motion
};

// Of all energy between 0.03 and 1 Hz in [begin, end). Unknown where the truth does not cover it, or does not
// move.
TrueDirection true_direction(const TruthSeries& truth, std::int64_t begin_utime, std::int64_t end_utime);

}  // namespace waverig::evaluation
