// Results of a campaign: the one structure behind results.csv, results.json, the figures and the report.
#pragma once
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "estimator/evaluation/true_direction.h"
#include "estimator/types.h"

namespace waverig::evaluation {

// One single wave held against the truth.
struct JudgedWave {
  estimator::Wave wave;
  double true_height_m = estimator::kUnknown;  // crest to trough of the true heave over the same span
};

inline constexpr double kCoverageFactor = 2;  // of expanded uncertainties; NIST TN 1297

// One contribution to the standard uncertainty of a mean height (GUM): name, value in metres, type A or B.
struct Contribution {
  std::string name;
  double sigma_m = 0;
  char type = 'B';
};

// Statistics of a set of waves; REFERENCE section 2. Lengths in metres; *_percent in percent.
struct HeightStatistics {
  std::int64_t waves = 0;
  double mean_height_m = estimator::kUnknown;
  double error_rate_percent = estimator::kUnknown;  // 100 |mean - set| / set
  double std_m = estimator::kUnknown;               // over single waves
  double rmse_m = estimator::kUnknown;              // single waves against their true heights
  double mean_error_percent = estimator::kUnknown;  // signed, mean against true mean
  double mean_true_height_m = estimator::kUnknown;
  double expanded_uncertainty_m = estimator::kUnknown;  // k = 2, of the mean height
  double bound_std_m =
      estimator::kUnknown;  // Cramer-Rao, REFERENCE section 3; unknown where noise is unknown
  double mean_period_s = estimator::kUnknown;
  std::vector<Contribution> budget;
  std::int32_t flags = 0;
};

// A method's sea state held against the truth of the same span.
struct JudgedSea {
  estimator::SeaState sea;
  double true_hm0_m = estimator::kUnknown;  // 4 standard deviations of the true heave
  double true_tm02_s =
      estimator::kUnknown;    // 2 pi times the ratio of the standard deviations of heave and rate
  TrueDirection direction{};  // where the method told one

  double direction_error_rad() const {  // told minus true, in [-pi, pi]; unknown where either is
    return std::remainder(sea.mean_direction_rad - direction.mean_direction_rad, 360 * kDegree);
  }
};

// What moved the sensor: waves of one height and period, or an irregular sea, whose height is Hm0.
enum class Motion { kUnknown, kRegular, kSea };

// One run, one method.
struct RunResult {
  std::string run;  // stem of runs/<run>.lcm
  std::string method;
  int repeat = 0;
  double period_s = 0;  // as set
  double height_m = 0;  // as set
  Motion motion = Motion::kUnknown;
  HeightStatistics statistics;
  std::vector<JudgedWave> waves;  // the steady ones
  std::vector<JudgedSea> seas;
  double heave_rmse_m = estimator::kUnknown;  // against the true heave over the steady part, mean removed
  double heave_bound_m =
      estimator::kUnknown;          // the least that can be, of a sea of known spectrum (heave_bound.h)
  std::int64_t excluded_waves = 0;  // in ramps or cut by the record's edge
  double heave_coverage =
      estimator::kUnknown;  // part of the steady time with heave; where waves were counted in it
  double heave_gain = estimator::kUnknown;   // estimated over true heave, least squares over the steady part
  double heave_lag_s = estimator::kUnknown;  // positive: the estimate comes late
  double heave_sigma_ratio =
      estimator::kUnknown;                   // rms of error over stated sigma; 1: honest, above: too sure
  double true_hm0_m = estimator::kUnknown;   // 4 standard deviations of the true heave over the steady part
  double true_tm02_s = estimator::kUnknown;  // of the true heave and its rate
  double noise_density_mps2_rthz =
      estimator::kUnknown;  // of the sensor's vertical acceleration, for the bound
};

// One setting and method, over its repeats: a row of results.csv.
struct CellResult {
  double period_s = 0;
  double height_m = 0;
  std::string method;
  Motion motion = Motion::kUnknown;
  HeightStatistics statistics;
  double heave_rmse_m = estimator::kUnknown;  // root of the mean square over the repeats
  // Of heave_rmse_m, k = 1, from its scatter over so many repeats; unknown of fewer than two. In no file:
  // told anew from the runs where results are read.
  double heave_rmse_sigma_m = estimator::kUnknown;
  int heave_runs = 0;
  double wave_rmse_sigma_m = estimator::kUnknown;  // likewise, of statistics.rmse_m
  int wave_runs = 0;
  double heave_bound_m = estimator::kUnknown;  // root of the mean square
  double true_hm0_m = estimator::kUnknown;     // this and the following: means over the repeats
  double heave_gain = estimator::kUnknown;
  double heave_lag_s = estimator::kUnknown;
  double heave_sigma_ratio = estimator::kUnknown;
  JudgedSea
      sea;  // mean of the sea states; directions averaged as unit vectors, unknown where they are all round
  double direction_error_rad = estimator::kUnknown;  // mean of told minus true
  double direction_rmse_rad = estimator::kUnknown;
};

struct CampaignResults {
  std::string name;
  std::string version;  // of waverig
  std::string command;  // as given
  std::string judged_version,
      judged_command;  // of a later waverig evaluate; empty where the campaign judged itself
  std::uint64_t seed = 0;
  bool complete = false;
  std::vector<CellResult> cells;  // by period, height, method
  std::vector<RunResult> runs;
  std::string calibration_json;  // report of the campaign's own calibration, verbatim
};

}  // namespace waverig::evaluation
