// Gain and lag of an estimated heave against the true one, frequency by frequency.
#pragma once
#include <span>
#include <vector>

#include "estimator/types.h"

namespace waverig::evaluation {

struct TransferPoint {
  double f_hz = 0;
  double gain = estimator::kUnknown;         // |E T*| / |T|^2
  double lag_s = estimator::kUnknown;        // positive: the estimate comes late
  double error_ratio = estimator::kUnknown;  // rms error over rms truth in this band
};

struct TransferSettings {
  double block_s = 60;  // bands are as wide as five of its lines; blocks overlap by half, under a Hann window
};

// Cross spectra of both series at the frequencies asked for, means over blocks and over five neighbouring
// lines. Both series are even, of one rate and of one length; unknown is what is shorter than a block.
std::vector<TransferPoint> transfer(std::span<const double> heave_m, std::span<const double> true_heave_m,
                                    double rate_hz, std::span<const double> frequencies_hz,
                                    const TransferSettings& settings = {});

}  // namespace waverig::evaluation
