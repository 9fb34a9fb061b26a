#include "rig/bench/simulation/chamber.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig::rig::bench {

void advance(const ChamberTruth& truth, const ChamberControls& controls, ChamberState& state, double dt_s) {
  state.time_s += dt_s;
  if (!controls.on) {
    state.air_degC += (truth.ambient_degC - state.air_degC) * -std::expm1(-dt_s / truth.idle_time_constant_s);
    state.rate_degC_s = 0;
    state.setpoint_degC = state.air_degC;  // switched on again, a ramp starts where the air is
    return;
  }
  const double step = controls.ramp_degC_s > 0 ? controls.ramp_degC_s * dt_s : 1e9;
  state.setpoint_degC += std::clamp(controls.target_degC - state.setpoint_degC, -step, step);
  const double omega = 2 * std::numbers::pi / truth.natural_period_s;
  const double ripple = (truth.ripple_degC + 10 * controls.hunting_degC) *
                        std::sin(2 * std::numbers::pi * state.time_s / truth.ripple_period_s);
  const double acceleration = omega * omega * (state.setpoint_degC + ripple - state.air_degC) -
                              2 * truth.damping * omega * state.rate_degC_s;
  state.rate_degC_s =
      std::clamp(state.rate_degC_s + acceleration * dt_s, -truth.rate_max_degC_s, truth.rate_max_degC_s);
  state.air_degC += state.rate_degC_s * dt_s;
}

}  // namespace waverig::rig::bench
