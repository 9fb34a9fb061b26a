#include "rig/nodes/simulated_rig.h"

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
  for (int i = 0; i < steps; ++i) {
    utime_ += step_us;
    drive_.advance(settings_.step_s);
    sensor = &arm_.advance(drive_.shaft(), settings_.step_s, utime_);
    unit_.step(*sensor, settings_.step_s, bytes_);
  }
  if (sensor != nullptr) publish_truth(bus_, *sensor, truth_seq_++, arm_.arm_angle_rad());
  return bytes_;
}

}  // namespace waverig::rig
