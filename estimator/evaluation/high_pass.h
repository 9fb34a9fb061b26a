// Zero-phase high-pass, for comparing two heave series above the frequencies that neither of them can know.
#pragma once
#include <span>
#include <vector>

namespace waverig::evaluation {

// Second-order Butterworth, forward and backward over the series with its ends reflected: gain 1/2 at the
// cut-off, no phase. values: evenly sampled, finite.
std::vector<double> high_passed(std::span<const double> values, double sample_rate_hz, double cut_off_hz);

}  // namespace waverig::evaluation
