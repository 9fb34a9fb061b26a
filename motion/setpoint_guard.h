// Watches the stream of setpoints itself, whatever made it: rate, acceleration and jerk by divided
// differences, which for any times never exceed the derivative's largest magnitude between them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "motion/limits.h"

namespace waverig::motion {

class SetpointGuard {
 public:
  explicit SetpointGuard(const AxisLimits& limits) : limits_(limits) {}
  void reset() { count_ = 0; }
  // utime strictly increasing. What of the limits this setpoint would break.
  std::optional<LimitExcess> check(std::int64_t utime, double angle_rad);

 private:
  AxisLimits limits_;
  int count_ = 0;
  std::array<std::int64_t, 4> utime_{};  // newest first
  std::array<double, 4> angle_rad_{};
};

}  // namespace waverig::motion
