#include "estimator/calibration/sample_steps.h"

#include <algorithm>
#include <vector>

namespace waverig::estimator {

double median_step_s(std::span<const ImuSample> samples) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps_s.push_back(static_cast<double>(samples[i].utime - samples[i - 1].utime) * kMicrosecond);
  if (steps_s.empty()) return 0;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return *middle;
}

double longest_step_s(std::span<const ImuSample> samples) {
  constexpr double kShortestGap_s = 0.1, kSteps = 2.5;
  return std::max(kShortestGap_s, kSteps * median_step_s(samples));
}

}  // namespace waverig::estimator
