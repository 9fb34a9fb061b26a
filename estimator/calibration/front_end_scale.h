// Scale factors of a current-to-frequency channel from readings at known currents; Kim, section 3.1.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "estimator/calibration/front_end.h"

namespace waverig::estimator {

// A row of the calibrator's data sheet: 95 % (k = 2).
struct CalibratorRange {
  double full_scale_A = 0;
  double relative = 0;
  double floor_A = 0;
};

// Kim, Table 2: 24 h relative uncertainty of the DC current.
inline const std::vector<CalibratorRange> kCalibratorTable2 = {
    {220e-6, 20e-6, 6e-9}, {2.2e-3, 20e-6, 7e-9}, {22e-3, 20e-6, 40e-9}, {220e-3, 20e-6, 0.7e-6}, {2.2, 32e-6, 12e-6}};

// One recording of one channel, in the order of measurement.
struct FrontEndReading {
  double level_A = 0;        // magnitude commanded; 0: a zero reading
  int polarity = 0;          // +1 or -1, made by the reversing switch; 0: channel open
  double range_A = 0;        // the calibrator's range, full scale
  double rate_N_Hz = 0;      // C_N of Kim, eq. (2)
  double rate_P_Hz = 0;      // C_P
  double duration_s = 0;
  double dmm_A = std::numeric_limits<double>::quiet_NaN();   // what the DMM read at this setting (DMM method)
  double dmm_range_A = 0;
};

// What is known beforehand of the bench, for the budget.
struct ScaleFactorKnowledge {
  std::vector<CalibratorRange> calibrator = kCalibratorTable2;
  double floor_drift = 0.05;          // standard deviation of the floor's change from zero to level reading, of the floor
  double leakage_limit_A = 0.1e-9;    // of the switch, rectangular
  double noise_A_sqrt_s = 0;          // white current noise of the channel, times the root of the averaging time
  double bias_wander_A = 0;           // standard deviation of the channel's bias change from zero to level reading
  double clock_ratio_sigma = 1e-8;    // relative, of one reading
  double dmm_relative = 12e-6;        // 95 %
  double dmm_drift_A = 1e-9;          // standard deviation of the DMM's offset between its two readings
};

// How the rows of the least squares are weighted. kLevel is Kim, eq. (11): each row divided by its level, so that a
// small current counts as much as a large one. kUncertainty divides by the row's own standard uncertainty instead.
enum class RowWeighting { kNone, kLevel, kUncertainty };

struct RowResidual {
  double level_A = 0;
  int polarity = 0;
  double relative = 0;       // (fitted - commanded) / level
};

struct ScaleFactors {
  double K_N_C = 0, K_P_C = 0;                                     // coulomb a pulse
  Eigen::Matrix2d covariance_random = Eigen::Matrix2d::Zero();     // relative; differs from one fit to the next
  Eigen::Matrix2d covariance_common = Eigen::Matrix2d::Zero();     // relative; the reference's own error
  std::vector<BudgetTerm> budget_N, budget_P;                      // relative
  std::vector<RowResidual> residuals;
};

// Calibrator method, eqs. (4)-(11), with eq. (7) read with -i_calbias: the switch reverses the calibrator's bias at zero
// as well, or eq. (9) does not follow. A level is held against the latest zero reading of its own polarity and range.
// Throws UserError where a zero reading is missing or the levels do not reach both polarities.
ScaleFactors scale_factors_by_calibrator(const std::vector<FrontEndReading>& readings,
                                         const ScaleFactorKnowledge& knowledge,
                                         RowWeighting weighting = RowWeighting::kLevel);

// DMM method, eqs. (12)-(18), with eq. (13) read with -i_calbias-. Half-differences over the two polarities remove every
// bias, but alone they only give K_N / K_N' + K_P / K_P' (all their rows are parallel), so the half-sums are rows too,
// with one unknown offset a DMM range. Throws UserError where a level lacks a polarity or its DMM reading.
ScaleFactors scale_factors_by_dmm(const std::vector<FrontEndReading>& readings, const ScaleFactorKnowledge& knowledge,
                                  RowWeighting weighting = RowWeighting::kLevel);

// One channel over temperature: DSF_N and DSF_P as laws with budgets; the reference's own error, common to all
// temperatures, is added to the constant term.
struct ScaleFactorsAtTemperature {
  double temperature_degC = 0;
  ScaleFactors factors;
};
void fit_scale_factor_laws(const std::vector<ScaleFactorsAtTemperature>& points, FrontEndChannel& channel,
                           const TemperatureLawSettings& settings = {});

}  // namespace waverig::estimator
