#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "estimator/evaluation/flag_names.h"
#include "estimator/evaluation/results_io.h"

namespace waverig::evaluation {
namespace {

struct Column {
  const char* name;
  double (*value)(const CellResult&);
};

// DESIGN: these first, in this order.
constexpr Column kAgreed[] = {
    {"mean_height_cm", [](const CellResult& c) { return c.statistics.mean_height_m / kCentimetre; }},
    {"error_rate_percent", [](const CellResult& c) { return c.statistics.error_rate_percent; }},
    {"std_cm", [](const CellResult& c) { return c.statistics.std_m / kCentimetre; }},
    {"expanded_uncertainty_cm",
     [](const CellResult& c) { return c.statistics.expanded_uncertainty_m / kCentimetre; }},
    {"rmse_cm", [](const CellResult& c) { return c.statistics.rmse_m / kCentimetre; }},
};

constexpr Column kMore[] = {
    {"true_height_cm", [](const CellResult& c) { return c.statistics.mean_true_height_m / kCentimetre; }},
    {"mean_error_percent", [](const CellResult& c) { return c.statistics.mean_error_percent; }},
    {"bound_std_cm", [](const CellResult& c) { return c.statistics.bound_std_m / kCentimetre; }},
    {"mean_period_s", [](const CellResult& c) { return c.statistics.mean_period_s; }},
    {"heave_rmse_cm", [](const CellResult& c) { return c.heave_rmse_m / kCentimetre; }},
    {"heave_rmse_percent", [](const CellResult& c) { return 100 * c.heave_rmse_m / c.true_hm0_m; }},
    {"heave_gain", [](const CellResult& c) { return c.heave_gain; }},
    {"heave_lag_s", [](const CellResult& c) { return c.heave_lag_s; }},
    {"heave_sigma_ratio", [](const CellResult& c) { return c.heave_sigma_ratio; }},
};

constexpr Column kSea[] = {
    {"hm0_cm", [](const CellResult& c) { return c.sea.sea.hm0_m / kCentimetre; }},
    {"true_hm0_cm", [](const CellResult& c) { return c.sea.true_hm0_m / kCentimetre; }},
    {"hm0_error_percent", [](const CellResult& c) { return 100 * (c.sea.sea.hm0_m / c.sea.true_hm0_m - 1); }},
    {"tm02_s", [](const CellResult& c) { return c.sea.sea.tm02_s; }},
    {"true_tm02_s", [](const CellResult& c) { return c.sea.true_tm02_s; }},
    {"tp_s", [](const CellResult& c) { return c.sea.sea.tp_s; }},
};

constexpr Column kHeaveBound[] = {
    {"heave_bound_percent", [](const CellResult& c) { return 100 * c.heave_bound_m / c.true_hm0_m; }},
};

constexpr Column kDirection[] = {
    {"mean_direction_deg", [](const CellResult& c) { return c.sea.sea.mean_direction_rad / kDegree; }},
    {"spread_deg", [](const CellResult& c) { return c.sea.sea.spread_rad / kDegree; }},
    {"peak_direction_deg", [](const CellResult& c) { return c.sea.sea.peak_direction_rad / kDegree; }},
    {"check_factor", [](const CellResult& c) { return c.sea.sea.check_factor; }},
    {"true_direction_deg", [](const CellResult& c) { return c.sea.direction.mean_direction_rad / kDegree; }},
    {"direction_error_deg", [](const CellResult& c) { return c.direction_error_rad / kDegree; }},
    {"direction_rmse_deg", [](const CellResult& c) { return c.direction_rmse_rad / kDegree; }},
    {"true_spread_deg", [](const CellResult& c) { return c.sea.direction.spread_rad / kDegree; }},
    {"true_check_factor", [](const CellResult& c) { return c.sea.direction.check_factor; }},
};

}  // namespace

std::string results_csv(std::span<const CellResult> cells) {
  const auto any_knows = [&](const Column& column) {
    return std::any_of(cells.begin(), cells.end(),
                       [&](const CellResult& c) { return std::isfinite(column.value(c)); });
  };
  std::vector<std::span<const Column>> groups = {kAgreed, kMore};
  if (any_knows(kSea[0])) groups.emplace_back(kSea);
  if (any_knows(kHeaveBound[0])) groups.emplace_back(kHeaveBound);
  if (std::any_of(std::begin(kDirection), std::end(kDirection), any_knows)) groups.emplace_back(kDirection);

  std::string text = "period_s,height_cm,method,waves";
  for (const auto& group : groups)
    for (const Column& column : group) text += std::string(",") + column.name;
  text += ",flags\n";
  for (const CellResult& cell : cells) {
    text += fmt::format("{:g},{:g},{},{}", cell.period_s, cell.height_m / kCentimetre, cell.method,
                        cell.statistics.waves);
    for (const auto& group : groups)
      for (const Column& column : group) {
        const double value = column.value(cell);
        text += std::isfinite(value) ? fmt::format(",{:.4f}", value) : ",";
      }
    text += fmt::format(",{}\n", fmt::join(flag_names(cell.statistics.flags), " "));
  }
  return text;
}

}  // namespace waverig::evaluation
