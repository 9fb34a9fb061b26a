// The time between the samples of a recording, as calibrations look at it.
#pragma once
#include <span>

#include "estimator/types.h"

namespace waverig::estimator {

// Gaps do not count. 0 where there are fewer than two samples.
double median_step_s(std::span<const ImuSample> samples);

// A longer step is a gap, across which nothing is averaged: a tenth of a second, and of slow recordings more
// than their jitter makes of two steps.
double longest_step_s(std::span<const ImuSample> samples);

}  // namespace waverig::estimator
