// Bias of a current-to-frequency channel against temperature, with its hysteresis, and the master oscillator's error;
// Kim, section 4: no input, the chamber ramps up and back.
#pragma once
#include <vector>

#include "estimator/calibration/front_end.h"

namespace waverig::estimator {

struct BiasReading {
  double temperature_degC = 0;
  double rate_N_Hz = 0, rate_P_Hz = 0;
  double duration_s = 0;
};

struct BiasSettings {
  double bin_degC = 1;          // width of the temperature bins in which the two ramps are compared
  double turn_degC = 1.0;       // this near to a turning point readings belong to neither ramp
  double lag_s = 60;            // the dies may follow the thermometer up to this late
  TemperatureLawSettings law = {20, 6, false};
};

struct BiasPoint {
  double temperature_degC = 0;
  double up_A = 0, down_A = 0;  // NaN where that ramp has no reading in the bin
};

struct BiasResult {
  TemperatureLaw law;                 // of the loop's middle; its sigma is the normal part of the budget
  std::vector<HalfLoop> half_loop;
  std::vector<BiasPoint> loop;
  double hysteresis_A = 0;            // full width where it is widest
  double hysteresis_rms_A = 0;        // full width, root mean square over temperature
  double noise_A = 0;                 // standard deviation of one reading about its ramp's neighbours
  std::vector<BudgetTerm> budget;     // the half loop counts with its root mean square
};

// i_bias = -(K_N C_N - K_P C_P) with no input. Readings in the order of measurement, ramp up first or down first.
// Throws UserError where one of the ramps is missing, naming the channel.
BiasResult fit_bias(const std::vector<BiasReading>& readings, const FrontEndChannel& channel,
                    const BiasSettings& settings = {});

// The master clock against a reference: reference_counts pulses of reference_Hz in what the master clock takes for
// nominal_s. df_MSTR = reference_Hz * nominal_s / counts - 1.
struct OscillatorReading {
  double temperature_degC = 0;
  double reference_counts = 0;
  double reference_Hz = 0;
  double nominal_s = 0;
};
struct OscillatorResult {
  TemperatureLaw law;
  std::vector<TemperaturePoint> points;
  std::vector<BudgetTerm> budget;
};
// reference_relative: 95 % (k = 2) of the function generator, Kim: 3 ppm.
OscillatorResult fit_oscillator(const std::vector<OscillatorReading>& readings, double reference_relative = 3e-6);

}  // namespace waverig::estimator
