// The two procedures of Kim in memory, without instruments or transports: one count per reading, for hundreds of units.
#pragma once
#include <map>
#include <vector>

#include "estimator/calibration/front_end_bias.h"
#include "estimator/calibration/front_end_scale.h"
#include "rig/bench/simulation/converter_unit.h"
#include "rig/bench/simulation/sources.h"

namespace waverig::rig::bench {

inline const std::vector<double> kTemperatures_degC = {-10, 5, 20, 35, 50};
inline const std::vector<double> kGyroLevels_A = {30e-6, 100e-6, 1e-3, 10e-3, 100e-3, 200e-3};     // Kim, Table 3
inline const std::vector<double> kAccelLevels_A = {500e-6, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3};
inline bool is_gyro(int channel) { return channel < kGyroChannels; }
inline const std::vector<double>& levels_of(int channel) { return is_gyro(channel) ? kGyroLevels_A : kAccelLevels_A; }

struct InMemoryBench {
  UnitTruth unit;
  CalibratorTruth calibrator;
  SwitchTruth matrix;
  DmmTruth dmm;
  RandomStream random, meter;
  UnitState state;

  InMemoryBench(std::uint64_t seed, const UnitSpread& spread = {})
      : unit(draw_unit(spread, seed)),
        calibrator(draw_calibrator(seed)),
        matrix(draw_switch(seed)),
        dmm(draw_dmm(seed)),
        random(seed, "in-memory bench"),
        meter(seed, "in-memory meter"),
        state(settled_unit(unit, kTemperatures_degC.front(), seed)) {}

  // Signed input; the recording as the acquisition would reduce it.
  estimator::FrontEndReading record(int channel, double level_A, double range_A, int polarity) {
    const std::size_t range = range_index(range_A);
    const double drift_A = random.gaussian(calibrator.floor_drift * estimator::kCalibratorTable2[range].floor_A);
    const double source_A = calibrator_A(calibrator, level_A, range, drift_A);
    std::array<double, kChannels> current{};
    const auto c = static_cast<std::size_t>(channel);
    current[c] = polarity * source_A + matrix.leakage_A[c][polarity > 0 ? 1 : 0];
    const std::uint64_t N = state.channels[c].N, P = state.channels[c].P, clock = state.clock;
    follow_temperature(unit, state, state.board_degC, 100);
    count(unit, state, current, 0, 10000);
    const double ratio = static_cast<double>(state.clock - clock) / (kConverterClock_Hz * 100);
    estimator::FrontEndReading r;
    r.level_A = level_A;
    r.polarity = polarity;
    r.range_A = range_A;
    r.duration_s = 100;
    r.rate_N_Hz = estimator::count_rate_Hz(static_cast<double>(state.channels[c].N - N), 100, ratio);
    r.rate_P_Hz = estimator::count_rate_Hz(static_cast<double>(state.channels[c].P - P), 100, ratio);
    r.dmm_range_A = range_A;
    r.dmm_A = polarity * source_A * (1 + dmm.gain[range]) + dmm.offset_A[range] +
              meter.gaussian(dmm.offset_drift_A) + random.gaussian(std::hypot(dmm.noise_relative * level_A, dmm.noise_A));
    return r;
  }

  // All settings of one channel at the present temperature, zero readings renewed on each range change.
  std::vector<estimator::FrontEndReading> settings(int channel) {
    std::vector<estimator::FrontEndReading> readings;
    double last_range_A = 0;
    for (const double level_A : levels_of(channel)) {
      const double range_A = estimator::kCalibratorTable2[range_index(level_A)].full_scale_A;
      if (range_A != last_range_A)
        for (const int polarity : {+1, -1}) readings.push_back(record(channel, 0, range_A, polarity));
      last_range_A = range_A;
      for (const int polarity : {+1, -1}) readings.push_back(record(channel, level_A, range_A, polarity));
    }
    return readings;
  }

  void set_temperature(double temperature_degC) {
    for (int i = 0; i < 400; ++i) follow_temperature(unit, state, temperature_degC, 60);
  }
};

inline estimator::ScaleFactorKnowledge knowledge_of(int channel, const UnitSpread& spread = {}) {
  const ChannelSpread& s = is_gyro(channel) ? spread.gyro : spread.accel;
  estimator::ScaleFactorKnowledge knowledge;
  knowledge.noise_A_sqrt_s = s.noise_A_sqrt_s;
  knowledge.bias_wander_A = s.wander_A;
  return knowledge;
}

}  // namespace waverig::rig::bench
