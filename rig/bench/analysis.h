// From a run's recordings to the calibration that they say; Kim, sections 3 and 4, by way of
// estimator/calibration.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimator/calibration/front_end_bias.h"
#include "estimator/calibration/front_end_scale.h"
#include "rig/bench/sequence.h"
#include "rig/bench/store.h"

namespace waverig::rig::bench {

struct ChannelAnalysis {
  std::string channel;
  std::vector<estimator::ScaleFactorsAtTemperature>
      scale_factors;                          // procedure scale_factor, scale_factor_dmm
  std::optional<estimator::BiasResult> bias;  // procedure bias
};

struct Analysis {
  estimator::FrontEndCalibration calibration;
  std::vector<ChannelAnalysis> channels;
  estimator::OscillatorResult oscillator;  // procedure bias
};

// known: scale factors from an earlier calibration for the bias procedure; nullptr: by design.
// Throws UserError where the recordings do not suffice.
Analysis analyse(const Sequence& sequence, const Store& store,
                 const estimator::FrontEndCalibration* known = nullptr);

std::string iso_time(std::int64_t utime);  // "2024-01-01T00:00:00Z"

}  // namespace waverig::rig::bench
