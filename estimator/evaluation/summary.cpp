#include "estimator/evaluation/summary.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "estimator/evaluation/flag_names.h"
#include "estimator/evaluation/height_statistics.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/flags.h"

namespace waverig::evaluation {

Summary summary_of(const std::string& method, const WaveStatistics& statistics) {
  Summary s;
  s.method = method;
  s.waves = statistics.waves;
  s.mean_height_m = statistics.mean_height_m;
  s.std_height_m = statistics.std_height_m;
  s.h13_m = statistics.h13_m;
  s.h110_m = statistics.h110_m;
  s.hmax_m = statistics.hmax_m;
  s.mean_period_s = statistics.mean_period_s;
  if (statistics.waves < 2) s.flags |= flag::kTooFewWaves;
  return s;
}

Summary summary_of(const std::string& method, std::span<const estimator::Wave> waves) {
  std::vector<CountedWave> counted;
  HeightAccumulator accumulator;
  for (const estimator::Wave& wave : waves) {
    if ((wave.flags & flag::kIncomplete) != 0) continue;
    counted.push_back(
        {wave.start_utime, wave.period_s, wave.height_m, wave.height_m / 2, -wave.height_m / 2});
    accumulator.add({wave, estimator::kUnknown});
  }
  accumulator.close_record();
  Summary s = summary_of(method, statistics_of(counted));
  const HeightStatistics heights = accumulator.statistics(estimator::kUnknown, estimator::kUnknown);
  s.budget = heights.budget;
  s.expanded_uncertainty_m = heights.expanded_uncertainty_m;
  s.flags |= heights.flags;
  return s;
}

void take_sea(Summary& summary, std::span<const estimator::SeaState> seas) {
  const estimator::SeaState *longest = nullptr, *directed = nullptr;
  const auto longer = [](const estimator::SeaState& sea, const estimator::SeaState* than) {
    return than == nullptr || sea.duration_s > than->duration_s;
  };
  // One with periods before one that came with a direction alone.
  const auto fuller = [&](const estimator::SeaState& sea, const estimator::SeaState* than) {
    const bool periods = std::isfinite(sea.tm02_s), its = than != nullptr && std::isfinite(than->tm02_s);
    return periods == its ? longer(sea, than) : periods || than == nullptr;
  };
  for (const estimator::SeaState& sea : seas) {
    if (std::isfinite(sea.hm0_m) && fuller(sea, longest)) longest = &sea;
    if (std::isfinite(sea.mean_direction_rad) && longer(sea, directed)) directed = &sea;
    summary.flags |= sea.flags;
  }
  if (longest != nullptr) {
    summary.hm0_m = longest->hm0_m;
    summary.tm01_s = longest->tm01_s;
    summary.tm02_s = longest->tm02_s;
    summary.tp_s = longest->tp_s;
  }
  if (directed != nullptr) {
    summary.mean_direction_deg = directed->mean_direction_rad / kDegree;
    summary.spread_deg = directed->spread_rad / kDegree;
    summary.peak_direction_deg = directed->peak_direction_rad / kDegree;
    summary.check_factor = directed->check_factor;
  }
}

std::string to_json(const Summary& s) {
  nlohmann::ordered_json json;
  json["method"] = s.method;
  json["waves"] = s.waves;
  const auto put = [&json](const char* key, double value) {
    if (std::isfinite(value)) json[key] = value;
  };
  put("mean_height_m", s.mean_height_m);
  put("std_height_m", s.std_height_m);
  put("h13_m", s.h13_m);
  put("h110_m", s.h110_m);
  put("hmax_m", s.hmax_m);
  put("mean_period_s", s.mean_period_s);
  put("hm0_m", s.hm0_m);
  put("tm01_s", s.tm01_s);
  put("tm02_s", s.tm02_s);
  put("tp_s", s.tp_s);
  put("expanded_uncertainty_m", s.expanded_uncertainty_m);
  for (const Contribution& c : s.budget) json["uncertainty_budget_m"][c.name] = c.sigma_m;
  put("mean_direction_deg", s.mean_direction_deg);
  put("spread_deg", s.spread_deg);
  put("peak_direction_deg", s.peak_direction_deg);
  put("check_factor", s.check_factor);
  put("heave_rms_error_m", s.heave_rms_error_m);
  put("heave_rms_error_percent", s.heave_rms_error_percent);
  put("heave_gain", s.heave_gain);
  put("heave_lag_s", s.heave_lag_s);
  json["flags"] = flag_names(s.flags);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_summary(const std::filesystem::path& path, const Summary& summary) {
  write_atomically(path, to_json(summary));
}

}  // namespace waverig::evaluation
