// `realtime` over a whole record.
#pragma once
#include <cstddef>
#include <vector>

#include "estimator/heave/realtime.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {

constexpr std::size_t kSettled = 30000;  // five minutes at 100 Hz

inline Collector run_realtime(const std::vector<estimator::ImuSample>& samples, double lag_s = 0) {
  estimator::MethodSettings settings;
  settings.fixed_lag_s = lag_s;
  estimator::Realtime method(settings);
  return run(method, samples);
}

}  // namespace waverig::testing
