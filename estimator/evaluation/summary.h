// summary.json: what one record's heave or waves come to.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"
#include "estimator/evaluation/zero_crossing.h"
#include "estimator/types.h"

namespace waverig::evaluation {

// Keys of summary.json; what is unknown (NaN) is left out of the file.
struct Summary {
  std::string method;
  std::int64_t waves = 0;
  double mean_height_m = estimator::kUnknown, std_height_m = estimator::kUnknown, h13_m = estimator::kUnknown,
         h110_m = estimator::kUnknown, hmax_m = estimator::kUnknown, mean_period_s = estimator::kUnknown,
         hm0_m = estimator::kUnknown, tm01_s = estimator::kUnknown, tm02_s = estimator::kUnknown,
         tp_s = estimator::kUnknown, expanded_uncertainty_m = estimator::kUnknown;
  double mean_direction_deg = estimator::kUnknown, spread_deg = estimator::kUnknown,
         peak_direction_deg = estimator::kUnknown, check_factor = estimator::kUnknown;
  double heave_rms_error_m = estimator::kUnknown;        // against a truth, where one was given
  double heave_rms_error_percent = estimator::kUnknown;  // of 4 standard deviations of that truth
  double heave_gain = estimator::kUnknown, heave_lag_s = estimator::kUnknown;
  std::vector<Contribution> budget;  // of the mean height, k = 1
  std::int32_t flags = 0;
};

// Counted waves of a heave series.
Summary summary_of(const std::string& method, const WaveStatistics& statistics);
// Single waves as a method found them, with the expanded uncertainty (k = 2) of their mean height and what it
// is made of (height_statistics.h).
Summary summary_of(const std::string& method, std::span<const estimator::Wave> waves);

// Spectral sea state, and direction where it is known: of the longest block, where there are several.
void take_sea(Summary& summary, std::span<const estimator::SeaState> seas);

std::string to_json(const Summary& summary);
void write_summary(const std::filesystem::path& path, const Summary& summary);  // atomic

}  // namespace waverig::evaluation
