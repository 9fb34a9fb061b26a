// Six-position calibration from a recording: a laboratory holds or lays the unit on each of its six sides for
// a while, in any order, and the still stretches are found in the samples.
//
// A stretch is still where neither reading scatters and no gap lies (sample_steps.h); it belongs to the side
// whose axis its mean is nearest to. Then as Lee 2014, eq. (1) and Table 1 (six_position.h); the gyroscope's
// offset is its mean over all still stretches.
#pragma once
#include <array>
#include <span>

#include "estimator/calibration/six_position.h"
#include "estimator/types.h"

namespace waverig::estimator {

struct SixPositionRecordSettings {
  double window_s = 1;                       // one mean of the uncertainty's batches
  double still_force_mps2 = 0.15;            // largest standard deviation of a still window, per axis
  double still_rate_radps = 0.02;            // and of the angular rate
  double largest_tilt_rad = 15 * kDegree;    // off the axis: further is between two sides
  double shortest_s = 5;                     // still in each position
  double fixture_sigma_rad = 0.5 * kDegree;  // standard uncertainty of the sides' angles
};

struct SixPositionRecord {
  SixPositionFit fit;
  GyroscopeCalibration gyroscope;
  std::array<double, 6> still_s{};  // in each position, in the order of kSixPositions
  double temperature_degC = kUnknown;
};

// Samples by nominal sensitivities. Throws UserError, naming the position, where one was not held long
// enough.
SixPositionRecord fit_six_position_record(std::span<const ImuSample> samples, double gravity_mps2,
                                          const SixPositionRecordSettings& settings = {});

}  // namespace waverig::estimator
