// What moves slowly inside a sensor unit: its temperature and the instability of a bias.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "motion/kinematics/frames.h"
#include "motion/kinematics/random.h"

namespace waverig::rig {

inline constexpr double kReferenceTemperature_degC = 25;  // data sheets speak of 25 degC

// offset + amplitude sin(2 pi t / period + phase) + warm_up (1 - exp(-t / warm_up_time)); t since the unit's
// power-up.
struct TemperatureSettings {
  double mean_degC = kReferenceTemperature_degC;
  double amplitude_degC = 0;
  double period_s = 3600;
  double warm_up_degC = 0;
  double warm_up_time_s = 600;
};

inline TemperatureSettings laboratory_temperature() { return {24, 0.5, 2400, 1.0, 900}; }

inline double temperature_degC(const TemperatureSettings& t, double since_power_up_s) {
  double value = t.mean_degC;
  if (t.amplitude_degC != 0)
    value += t.amplitude_degC * std::sin(2 * std::numbers::pi * since_power_up_s / t.period_s);
  if (t.warm_up_degC != 0) value += t.warm_up_degC * (1 - std::exp(-since_power_up_s / t.warm_up_time_s));
  return value;
}

// First-order Gauss-Markov process, stationary from the start: exact at any step. Sigma 0 switches it off.
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double correlation_time_s, double step_s, RandomStream& random)
      : decay_(std::exp(-step_s / correlation_time_s)), kick_(sigma * std::sqrt(1 - decay_ * decay_)) {
    if (sigma > 0) value_ = {random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma)};
  }
  const Vector3d& advance(RandomStream& random) {
    if (kick_ > 0)
      for (int i = 0; i < 3; ++i) value_[i] = decay_ * value_[i] + random.gaussian(kick_);
    return value_;
  }

 private:
  double decay_, kick_;
  Vector3d value_ = Vector3d::Zero();
};

}  // namespace waverig::rig
