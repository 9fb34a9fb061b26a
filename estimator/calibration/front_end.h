// What the calibration of the current-to-frequency front end says, and how the acquisition applies it.
//
// Kim, eqs. (1), (2), per channel:  i = K_N C_N - K_P C_P + i_bias,  K_N = K_N0 (1 + DSF_N),  K_P = K_P0 (1 + DSF_P),
// with C = (N / t) (1 + df_MSTR) / (1 + df_AF), both DSF and the bias being functions of temperature.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/calibration/temperature_law.h"

namespace waverig::estimator {

// One contribution to a standard uncertainty (k = 1), in the unit of the quantity it belongs to. GUM type A or B.
struct BudgetTerm {
  std::string name;
  double sigma = 0;
  char type = 'B';
};

double combined_sigma(const std::vector<BudgetTerm>& budget);   // root of the sum of squares

// Kim, eq. (1): the clock term. nominal_s is the interval as the master clock counts it; clock_ratio is
// (1 + df_AF) / (1 + df_MSTR), which is what counting the converter's clock with the master clock gives.
inline double count_rate_Hz(double counts, double nominal_s, double clock_ratio) {
  return counts / (nominal_s * clock_ratio);
}

// Half of the hysteresis at a temperature: (coming from cold minus coming from hot) / 2, with its sign.
struct HalfLoop {
  double temperature_degC = 0;
  double half_A = 0;
};

struct FrontEndChannel {
  std::string name;
  double K_N0_C = 0, K_P0_C = 0;      // coulomb a pulse, by design
  TemperatureLaw dsf_N, dsf_P;        // relative
  TemperatureLaw bias_A;              // middle of the hysteresis loop
  std::vector<HalfLoop> bias_loop;    // ascending in temperature; empty: no hysteresis known
  std::vector<BudgetTerm> dsf_N_budget, dsf_P_budget, bias_budget;   // at the reference temperature

  double K_N_C(double temperature_degC) const { return K_N0_C * (1 + dsf_N.at(temperature_degC)); }
  double K_P_C(double temperature_degC) const { return K_P0_C * (1 + dsf_P.at(temperature_degC)); }
  double half_loop_A(double temperature_degC) const;   // straight lines between the points, level outside
  // 95 % expanded uncertainty of the bias at a temperature reached from either side: the loop's two branches are
  // equally likely, and the normal part of the budget stands about each. Its half is the stated u for k = 2.
  double bias_expanded_A(double temperature_degC) const;
  // Kim, eq. (2): the mean current over the counting interval, in ampere.
  double current_A(double rate_N_Hz, double rate_P_Hz, double temperature_degC) const {
    return K_N_C(temperature_degC) * rate_N_Hz - K_P_C(temperature_degC) * rate_P_Hz + bias_A.at(temperature_degC);
  }
};

struct FrontEndCalibration {
  std::string id;                     // unique in a history
  std::string procedure;              // scale_factor, scale_factor_dmm, bias, or what was merged
  std::string measured;               // ISO 8601, UTC
  std::string unit;                   // what was calibrated: name and serial number
  std::string version;                // of the program
  std::vector<std::string> instruments;  // name: identity, as each answered
  std::vector<std::string> files;     // name: fingerprint, of the sequence and all it includes
  std::vector<FrontEndChannel> channels;
  TemperatureLaw oscillator;          // df_MSTR, relative
  std::vector<BudgetTerm> oscillator_budget;

  // Throws UserError where there is no such channel, naming the known ones.
  const FrontEndChannel& channel(std::string_view name) const;
};

// Scale factors of one, bias and oscillator of the other (Kim: the bias found beside the scale factors is not used).
// Throws UserError where the two are of different units or channels.
FrontEndCalibration merge(const FrontEndCalibration& scale_factor, const FrontEndCalibration& bias);

// The calibration file is JSON. Both throw UserError, naming file, key and what was expected.
std::string to_json(const FrontEndCalibration& calibration);
FrontEndCalibration front_end_calibration_from_json(const std::string& text, const std::string& name);
void save(const FrontEndCalibration& calibration, const std::filesystem::path& path);   // whole or not at all
FrontEndCalibration load_front_end_calibration(const std::filesystem::path& path);

}  // namespace waverig::estimator
