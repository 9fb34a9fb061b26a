#include "motion/limits.h"

#include <fmt/format.h>

#include <cmath>

namespace waverig::motion {

std::string LimitExcess::sentence() const {
  switch (kind) {
    case LimitKind::kRate:
      return fmt::format("angular rate {:.4g} rad/s is beyond the axis limit {:.4g} rad/s", value, limit);
    case LimitKind::kAccel:
      return fmt::format("angular acceleration {:.4g} rad/s^2 is beyond the axis limit {:.4g} rad/s^2", value,
                         limit);
    case LimitKind::kJerk:
      break;
  }
  return fmt::format("angular jerk {:.4g} rad/s^3 is beyond the axis limit {:.4g} rad/s^3", value, limit);
}

std::optional<LimitExcess> exceeds(const AxisLimits& limits, double rate_radps, double accel_radps2,
                                   double jerk_radps3) {
  // Written so that NaN is beyond every limit.
  const auto inside = [](double value, double limit) { return std::abs(value) <= limit * (1 + 1e-9); };
  if (!inside(rate_radps, limits.rate_radps))
    return LimitExcess{LimitKind::kRate, std::abs(rate_radps), limits.rate_radps};
  if (!inside(accel_radps2, limits.accel_radps2))
    return LimitExcess{LimitKind::kAccel, std::abs(accel_radps2), limits.accel_radps2};
  if (!inside(jerk_radps3, limits.jerk_radps3))
    return LimitExcess{LimitKind::kJerk, std::abs(jerk_radps3), limits.jerk_radps3};
  return std::nullopt;
}

std::optional<LimitExcess> exceeds(const AxisLimits& limits, const RotationProfile& profile) {
  const ProfilePeaks peaks = profile.peaks();
  return exceeds(limits, peaks.rate_radps, peaks.accel_radps2, peaks.jerk_radps3);
}

}  // namespace waverig::motion
