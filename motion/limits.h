// What the axis may do, and whether a profile stays inside.
#pragma once
#include <optional>
#include <string>

#include "motion/profile.h"

namespace waverig::motion {

// Magnitudes at the arm.
struct AxisLimits {
  double rate_radps = 7;
  double accel_radps2 = 10;
  double jerk_radps3 = 40;
};

enum class LimitKind { kRate, kAccel, kJerk };

struct LimitExcess {
  LimitKind kind;
  double value;  // rad/s, rad/s^2 or rad/s^3
  double limit;
  std::string sentence() const;
};

// The first limit that the values break; a relative tolerance of 1e-9 forgives rounding.
std::optional<LimitExcess> exceeds(const AxisLimits& limits, double rate_radps, double accel_radps2,
                                   double jerk_radps3);
std::optional<LimitExcess> exceeds(const AxisLimits& limits, const RotationProfile& profile);

}  // namespace waverig::motion
