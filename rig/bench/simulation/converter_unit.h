// The converter unit on the bench: ten current-to-frequency channels (six for gyroscopes, four for
// accelerometers), their clocks and their thermometer, after Kim, sections 2 and 4. Built on the rig's
// ChargeBalanceConverter.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>

#include "motion/kinematics/random.h"
#include "rig/frontend/charge_balance.h"

namespace waverig::rig::bench {

inline constexpr int kChannels = 10;
inline constexpr int kGyroChannels = 6;             // the first six; Kim, section 2.2
inline constexpr double kTick_s = 0.01;             // of the master clock
inline constexpr double kConverterClock_Hz = 10e6;  // nominal
inline constexpr double kConverterReference_degC = 20;

// Coefficients of (T - 20 degC)^0, ^1, ^2, ^3.
using Cubic = std::array<double, 4>;
double cubic_at(const Cubic& c, double temperature_degC);

// A mechanism with memory: a play operator of half width width_degC that shifts the bias by up to
// +-amplitude_A.
struct Hysteresis {
  double amplitude_A = 0;
  double width_degC = 1;
};

struct ChannelTruth {
  double K_N0_C = 0, K_P0_C = 0;  // by design
  Cubic dsf_N{}, dsf_P{};         // relative
  Cubic bias_A{};
  std::array<Hysteresis, 2> hysteresis{};
  double droop = 0;           // relative change of both quanta at the full rate
  double noise_A_sqrt_s = 0;  // white
  double wander_A = 0;        // Gauss-Markov, 1000 s
};

struct UnitTruth {
  std::array<ChannelTruth, kChannels> channels;
  Cubic master_error{}, converter_clock_error{};  // df_MSTR, df_AF, relative
  double thermometer_offset_degC = 0;
  double board_lag_s = 900, die_lag_s = 30;  // board behind the air, dies behind the board
};

// How units scatter about their design; standard deviations. Gyroscope channels first, accelerometer channels
// second.
struct ChannelSpread {
  double quantum_C = 0;
  Cubic dsf{};
  double dsf_asymmetry = 0.3;  // part of each coefficient that N and P do not share
  Cubic bias_A{};
  double hysteresis_A = 0;  // of each of the two mechanisms
  double droop = 0;
  double noise_A_sqrt_s = 0;
  double wander_A = 0;
};
struct UnitSpread {
  ChannelSpread gyro{
      30e-9, {300e-6, 5e-6, 0.03e-6, 0.2e-9}, 0.3, {100e-9, 2e-9, 0.02e-9, 0}, 2e-9, 2e-6, 1e-9, 0.2e-9};
  ChannelSpread accel{
      2.5e-9, {400e-6, 8e-6, 0.05e-6, 0.3e-9}, 0.3, {300e-9, 5e-9, 0.05e-9, 0}, 6e-9, 2e-6, 0.3e-9, 0.1e-9};
  Cubic master_error{5e-6, 0.1e-6, 5e-9, 0}, converter_clock_error{20e-6, 0.5e-6, 10e-9, 0};
};
UnitTruth draw_unit(const UnitSpread& spread, std::uint64_t seed);

std::string channel_name(int channel);  // gyro_1 … gyro_6, accel_1 … accel_4

// All that the unit remembers, trivially copyable: the simulated laboratory's state is kept with each step.
struct ChannelState {
  double remainder_C = 0;
  std::uint64_t N = 0, P = 0;  // pulses since power-up
  std::array<double, 2> play_degC{};
  double wander_A = 0;
  double bias_A = 0;                        // at the present temperature and history
  double quantum_N_C = 1, quantum_P_C = 1;  // at the present temperature, for df_AF = 0
};
struct UnitState {
  double board_degC = kConverterReference_degC, die_degC = kConverterReference_degC;
  std::array<ChannelState, kChannels> channels{};
  std::uint64_t ticks = 0, clock = 0,
                reference = 0;  // master ticks; pulses counted of converter clock and reference
  double clock_fraction = 0, reference_fraction = 0;
  double master_error = 0, converter_clock_error = 0;  // now
  RandomStream noise{0, "unset"};
};
static_assert(std::is_trivially_copyable_v<UnitState>);

// At rest at a temperature since long.
UnitState settled_unit(const UnitTruth& truth, double temperature_degC, std::uint64_t noise_seed);
// The thermal side, dt_s long: everything that follows the temperature.
void follow_temperature(const UnitTruth& truth, UnitState& state, double air_degC, double dt_s);
// The true length of that many master ticks now.
double true_s(const UnitState& state, int ticks);
// The electrical side: that many master ticks with these currents into the channels and this reference
// frequency.
void count(const UnitTruth& truth, UnitState& state, const std::array<double, kChannels>& current_A,
           double reference_Hz, int ticks);
double thermometer_degC(const UnitTruth& truth, const UnitState& state);

}  // namespace waverig::rig::bench
