#include "rig/bench/simulation/converter_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waverig::rig::bench {
namespace {

constexpr double kWanderTime_s = 1000;
constexpr double kFullRate_Hz = kConverterClock_Hz;  // one pulse a clock at most

void tune(const UnitTruth& truth, UnitState& state) {
  state.master_error = cubic_at(truth.master_error, state.board_degC);
  state.converter_clock_error = cubic_at(truth.converter_clock_error, state.board_degC);
  for (int i = 0; i < kChannels; ++i) {
    const ChannelTruth& t = truth.channels[static_cast<std::size_t>(i)];
    ChannelState& c = state.channels[static_cast<std::size_t>(i)];
    c.quantum_N_C = t.K_N0_C * (1 + cubic_at(t.dsf_N, state.die_degC));
    c.quantum_P_C = t.K_P0_C * (1 + cubic_at(t.dsf_P, state.die_degC));
    c.bias_A = cubic_at(t.bias_A, state.die_degC) + c.wander_A;
    for (std::size_t k = 0; k < 2; ++k) {
      const Hysteresis& h = t.hysteresis[k];
      c.play_degC[k] =
          std::clamp(c.play_degC[k], state.die_degC - h.width_degC, state.die_degC + h.width_degC);
      c.bias_A += h.amplitude_A * (c.play_degC[k] - state.die_degC) / h.width_degC;
    }
  }
}

void count_clock(double frequency_Hz, double dt_s, double& fraction, std::uint64_t& pulses) {
  fraction += frequency_Hz * dt_s;
  const double whole = std::floor(fraction);
  pulses += static_cast<std::uint64_t>(whole);
  fraction -= whole;
}

}  // namespace

double cubic_at(const Cubic& c, double temperature_degC) {
  const double x = temperature_degC - kConverterReference_degC;
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

std::string channel_name(int channel) {
  return channel < kGyroChannels ? fmt::format("gyro_{}", channel + 1)
                                 : fmt::format("accel_{}", channel - kGyroChannels + 1);
}

UnitTruth draw_unit(const UnitSpread& spread, std::uint64_t seed) {
  UnitTruth truth;
  for (int i = 0; i < kChannels; ++i) {
    const ChannelSpread& s = i < kGyroChannels ? spread.gyro : spread.accel;
    RandomStream random(seed, "converter " + channel_name(i));
    ChannelTruth& t = truth.channels[static_cast<std::size_t>(i)];
    t.K_N0_C = t.K_P0_C = s.quantum_C;
    for (std::size_t k = 0; k < 4; ++k) {
      const double shared = std::sqrt(1 - s.dsf_asymmetry * s.dsf_asymmetry) * random.gaussian();
      t.dsf_N[k] = s.dsf[k] * (shared + s.dsf_asymmetry * random.gaussian());
      t.dsf_P[k] = s.dsf[k] * (shared + s.dsf_asymmetry * random.gaussian());
      t.bias_A[k] = random.gaussian(s.bias_A[k]);
    }
    t.hysteresis = {{{random.gaussian(s.hysteresis_A), 3.0}, {random.gaussian(s.hysteresis_A), 8.0}}};
    t.droop = random.gaussian(s.droop);
    t.noise_A_sqrt_s = s.noise_A_sqrt_s;
    t.wander_A = s.wander_A;
  }
  RandomStream random(seed, "clocks");
  for (std::size_t k = 0; k < 4; ++k) {
    truth.master_error[k] = random.gaussian(spread.master_error[k]);
    truth.converter_clock_error[k] = random.gaussian(spread.converter_clock_error[k]);
  }
  truth.thermometer_offset_degC = random.gaussian(0.2);
  return truth;
}

UnitState settled_unit(const UnitTruth& truth, double temperature_degC, std::uint64_t noise_seed) {
  UnitState state;
  state.board_degC = state.die_degC = temperature_degC;
  state.noise = RandomStream(noise_seed, "converter noise");
  for (std::size_t i = 0; i < kChannels; ++i) {
    state.channels[i].play_degC = {temperature_degC, temperature_degC};
    state.channels[i].wander_A = state.noise.gaussian(truth.channels[i].wander_A);
  }
  tune(truth, state);
  return state;
}

void follow_temperature(const UnitTruth& truth, UnitState& state, double air_degC, double dt_s) {
  state.board_degC += (air_degC - state.board_degC) * -std::expm1(-dt_s / truth.board_lag_s);
  state.die_degC += (state.board_degC - state.die_degC) * -std::expm1(-dt_s / truth.die_lag_s);
  const double keep = std::exp(-dt_s / kWanderTime_s);
  for (std::size_t i = 0; i < kChannels; ++i) {
    double& wander = state.channels[i].wander_A;
    wander = keep * wander + state.noise.gaussian(truth.channels[i].wander_A * std::sqrt(1 - keep * keep));
  }
  tune(truth, state);
}

double true_s(const UnitState& state, int ticks) { return ticks * kTick_s / (1 + state.master_error); }

void count(const UnitTruth& truth, UnitState& state, const std::array<double, kChannels>& current_A,
           double reference_Hz, int ticks) {
  const double dt_s = true_s(state, ticks), root_s = std::sqrt(dt_s);
  for (std::size_t i = 0; i < kChannels; ++i) {
    const ChannelTruth& t = truth.channels[i];
    ChannelState& c = state.channels[i];
    const double droop = 1 + t.droop * std::abs(current_A[i]) / (t.K_N0_C * kFullRate_Hz);
    ChargeBalanceConverter converter({.positive_quantum_C = c.quantum_P_C * droop,
                                      .negative_quantum_C = c.quantum_N_C * droop,
                                      .bias_A = c.bias_A,
                                      .reset_clock_error = state.converter_clock_error,
                                      .largest_rate_Hz = kFullRate_Hz});
    converter.integrate(c.remainder_C, 0);  // what the last interval left
    converter.integrate(current_A[i] * dt_s + state.noise.gaussian(t.noise_A_sqrt_s * root_s), dt_s);
    const ConverterCounts counts = converter.take();
    c.N += static_cast<std::uint64_t>(counts.negative);
    c.P += static_cast<std::uint64_t>(counts.positive);
    c.remainder_C = converter.remainder_C();
  }
  count_clock(kConverterClock_Hz * (1 + state.converter_clock_error), dt_s, state.clock_fraction,
              state.clock);
  count_clock(reference_Hz, dt_s, state.reference_fraction, state.reference);
  state.ticks += static_cast<std::uint64_t>(ticks);
}

double thermometer_degC(const UnitTruth& truth, const UnitState& state) {
  return state.board_degC + truth.thermometer_offset_degC;
}

}  // namespace waverig::rig::bench
