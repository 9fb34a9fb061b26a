// Calibrator, switch matrix, DMM and function generator as what they do to a current; their data sheets'
// errors drawn.
#pragma once
#include <array>
#include <cstdint>

#include "estimator/calibration/front_end_scale.h"
#include "rig/bench/simulation/converter_unit.h"

namespace waverig::rig::bench {

inline constexpr std::size_t kRanges = 5;  // of Kim, Table 2

// Sources only: the current is positive, a switch reverses it. Data sheets state 95 %, drawn as k = 2.
struct CalibratorTruth {
  std::array<double, kRanges> gain{};    // relative error, by range
  std::array<double, kRanges> bias_A{};  // range-dependent offset
  double floor_drift = 0.05;             // of the floor: how much the offset moves with each new setting
  double settling_s = 0.2;
};
CalibratorTruth draw_calibrator(std::uint64_t seed);

// The smallest range that holds the level; the last one where none does.
std::size_t range_index(double range_A);

// What the calibrator gives, at rest: drift_A is that of the present setting.
double calibrator_A(const CalibratorTruth& truth, double level_A, std::size_t range, double drift_A);

struct SwitchTruth {
  std::array<std::array<double, 2>, kChannels> leakage_A{};  // by channel and polarity, below 0.1 nA
  double open_leakage_A = 0;
};
SwitchTruth draw_switch(std::uint64_t seed);

struct DmmTruth {
  std::array<double, kRanges> gain{};
  std::array<double, kRanges> offset_A{};
  double noise_relative = 0.5e-6, noise_A = 0.2e-9;
  double offset_drift_A = 1e-9;  // how much the offset has moved at each new level
};
DmmTruth draw_dmm(std::uint64_t seed);

struct GeneratorTruth {
  double error = 0;  // relative; 3 ppm at 95 %
};
GeneratorTruth draw_generator(std::uint64_t seed);

}  // namespace waverig::rig::bench
