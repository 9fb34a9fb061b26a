#include "rig/nodes/simulated_rig.h"

#include <algorithm>
#include <cmath>

#include "rig/nodes/truth_publisher.h"

namespace waverig::rig {

SimulatedRig::SimulatedRig(Bus& bus, const SimulatedRigSettings& settings, const UnitParameters& unit,
                           std::int64_t start_utime)
    : bus_(bus),
      settings_(settings),
      drive_(settings.drive, start_utime),
      arm_(settings.arm, settings.radius_m),
      unit_(settings.unit, unit, settings.noise_seed),
      utime_(start_utime) {
  unit_.step(arm_.advance(drive_.shaft(), 0, utime_), 0, bytes_);
}

std::span<const std::uint8_t> SimulatedRig::advance(double duration_s) {
  bytes_.clear();
  const auto steps = static_cast<int>(std::lround(duration_s / settings_.step_s));
  const auto step_us = static_cast<std::int64_t>(std::lround(settings_.step_s * 1e6));
  const BodyMotion* sensor = nullptr;
  for (int i = 0; i < steps; ++i) sensor = &step(settings_.step_s, step_us);
  if (sensor != nullptr) tell_truth(*sensor);
  return bytes_;
}

std::span<const std::uint8_t> SimulatedRig::advance_to(std::int64_t utime) {
  bytes_.clear();
  const auto whole_us = static_cast<std::int64_t>(std::lround(settings_.step_s * 1e6));
  while (utime_ < utime) {
    const std::int64_t step_us = std::min(whole_us, utime - utime_);
    const BodyMotion& sensor = step(1e-6 * static_cast<double>(step_us), step_us);
    if (utime_ < next_truth_utime_) continue;
    next_truth_utime_ = utime_ + static_cast<std::int64_t>(settings_.truth_interval_s * 1e6);
    tell_truth(sensor);
  }
  return bytes_;
}

const BodyMotion& SimulatedRig::step(double step_s, std::int64_t step_us) {
  utime_ += step_us;
  drive_.advance(step_s);
  const BodyMotion& sensor = arm_.advance(drive_.shaft(), step_s, utime_);
  unit_.step(sensor, step_s, bytes_);
  return sensor;
}

void SimulatedRig::tell_truth(const BodyMotion& sensor) {
  publish_truth(bus_, sensor, truth_seq_++, arm_.arm_angle_rad());
}

}  // namespace waverig::rig
