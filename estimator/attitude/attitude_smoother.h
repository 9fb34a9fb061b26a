// Attitude of a whole record, forward and backward: the AttitudeFilter's chain with a Rauch-Tung-Striebel
// pass.
#pragma once
#include <vector>

#include "estimator/attitude/attitude_filter.h"

namespace waverig::estimator {

// One AttitudeSample per ImuSample, same utime. Samples in increasing utime (repeats and stragglers dropped).
// Two passes, the second starting from the first's smoothed attitude and bias, so that the start is as good
// as the rest; where such a start is given, one. Linear in time and memory; an empty record gives an empty
// answer. live, where given, becomes the filter as it stands after the last sample, to go on with.
std::vector<AttitudeSample> smooth_attitude(const std::vector<ImuSample>& samples,
                                            const AttitudeSettings& settings, AttitudeFilter* live = nullptr,
                                            const AttitudeSample* start = nullptr);

}  // namespace waverig::estimator
