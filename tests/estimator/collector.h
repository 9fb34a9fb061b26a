// Keeps all that a method gives.
#pragma once
#include <vector>

#include "estimator/method.h"

namespace waverig::testing {

struct Collector : estimator::Output {
  std::vector<estimator::HeaveSample> heaves;
  std::vector<estimator::Wave> waves;
  std::vector<estimator::SeaState> seas;
  void heave(const estimator::HeaveSample& h) override { heaves.push_back(h); }
  void wave(const estimator::Wave& w) override { waves.push_back(w); }
  void sea(const estimator::SeaState& s) override { seas.push_back(s); }
};

inline Collector run(estimator::Method& method, const std::vector<estimator::ImuSample>& samples) {
  Collector collector;
  for (const estimator::ImuSample& sample : samples) method.add(sample, collector);
  method.finish(collector);
  return collector;
}

}  // namespace waverig::testing
