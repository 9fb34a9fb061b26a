#include "rig/bench/simulation/sources.h"

namespace waverig::rig::bench {

using estimator::kCalibratorTable2;

CalibratorTruth draw_calibrator(std::uint64_t seed) {
  CalibratorTruth truth;
  RandomStream random(seed, "calibrator");
  for (std::size_t i = 0; i < kRanges; ++i) {
    truth.gain[i] = random.gaussian(kCalibratorTable2[i].relative / 2);
    truth.bias_A[i] = random.gaussian(kCalibratorTable2[i].floor_A / 2);
  }
  return truth;
}

std::size_t range_index(double range_A) {
  for (std::size_t i = 0; i + 1 < kRanges; ++i)
    if (range_A <= kCalibratorTable2[i].full_scale_A * (1 + 1e-9)) return i;
  return kRanges - 1;
}

double calibrator_A(const CalibratorTruth& truth, double level_A, std::size_t range, double drift_A) {
  return level_A * (1 + truth.gain[range]) + truth.bias_A[range] + drift_A;
}

SwitchTruth draw_switch(std::uint64_t seed) {
  SwitchTruth truth;
  RandomStream random(seed, "switch matrix");
  for (auto& channel : truth.leakage_A)
    for (double& leakage : channel) leakage = random.uniform(-0.1e-9, 0.1e-9);
  truth.open_leakage_A = random.uniform(-0.02e-9, 0.02e-9);
  return truth;
}

DmmTruth draw_dmm(std::uint64_t seed) {
  DmmTruth truth;
  RandomStream random(seed, "dmm");
  for (std::size_t i = 0; i < kRanges; ++i) {
    truth.gain[i] = random.gaussian(6e-6);
    truth.offset_A[i] = random.gaussian(2e-6 * kCalibratorTable2[i].full_scale_A);
  }
  return truth;
}

GeneratorTruth draw_generator(std::uint64_t seed) {
  return {RandomStream(seed, "function generator").gaussian(1.5e-6)};
}

}  // namespace waverig::rig::bench
