// A heave series against a measured truth, e.g. optical motion capture.
#pragma once
#include "estimator/evaluation/heave_comparison.h"
#include "estimator/evaluation/heave_csv.h"

namespace waverig::evaluation {

struct AgainstTruthSettings {
  double high_pass_hz = 0;  // both series, zero phase; 0: only the means are removed
};

// Compares at the truth's instants that lie within the heave series, in no gap of either, and whose truth is
// known; where the truth marks what is moving, only there. Throws UserError where nothing is left to compare,
// and where high_pass_hz is not below half the rate of the truth.
HeaveComparison compare_with_truth(const HeaveSeries& heave, const HeaveSeries& truth,
                                   const AgainstTruthSettings& settings);

}  // namespace waverig::evaluation
