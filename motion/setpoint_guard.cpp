#include "motion/setpoint_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waverig::motion {

std::optional<LimitExcess> SetpointGuard::check(std::int64_t utime, double angle_rad) {
  for (std::size_t i = 3; i > 0; --i) {
    utime_[i] = utime_[i - 1];
    angle_rad_[i] = angle_rad_[i - 1];
  }
  utime_[0] = utime;
  angle_rad_[0] = angle_rad;
  count_ = std::min(count_ + 1, 4);
  if (count_ < 2) return std::nullopt;

  // k! f[t0 .. tk], k = 1, 2, 3
  std::array<double, 4> difference = angle_rad_;
  std::array<double, 3> derivative{};
  for (std::size_t k = 1; k < static_cast<std::size_t>(count_); ++k) {
    for (std::size_t i = 0; i + k < static_cast<std::size_t>(count_); ++i)
      difference[i] = static_cast<double>(k) * (difference[i] - difference[i + 1]) /
                      (1e-6 * static_cast<double>(utime_[i] - utime_[i + k]));
    derivative[k - 1] = difference[0];
  }
  // Rounding of the angles grows with each difference.
  const double step_s = 1e-6 * static_cast<double>(utime_[0] - utime_[1]);
  const double rounding_rad = 8 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(angle_rad));
  const AxisLimits forgiving{limits_.rate_radps * (1 + 1e-6) + rounding_rad / step_s,
                             limits_.accel_radps2 * (1 + 1e-6) + rounding_rad / (step_s * step_s),
                             limits_.jerk_radps3 * (1 + 1e-6) + rounding_rad / (step_s * step_s * step_s)};
  return exceeds(forgiving, derivative[0], derivative[1], derivative[2]);
}

}  // namespace waverig::motion
