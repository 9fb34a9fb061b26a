#include "render/figures/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "estimator/evaluation/compare.h"
#include "motion/kinematics/frames.h"
#include "render/figures/methods.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

std::vector<Setting> settings_of(const CampaignResults& results) {
  std::set<Setting> settings;
  for (const CellResult& cell : results.cells) settings.insert({cell.period_s, cell.height_m});
  return {settings.begin(), settings.end()};
}

const CellResult* cell_of(const CampaignResults& results, const Setting& setting, const std::string& method) {
  for (const CellResult& cell : results.cells) {
    if (cell.period_s == setting.period_s && cell.height_m == setting.height_m && cell.method == method)
      return &cell;
  }
  return nullptr;
}

bool tells_direction_alone(const evaluation::CellResult& cell) {
  return std::isfinite(cell.sea.sea.spread_rad) && cell.statistics.waves == 0 &&
         !std::isfinite(cell.heave_rmse_m);
}

bool is_beyond_uncertainty(const evaluation::HeightStatistics& s) {
  return std::abs(s.mean_height_m - s.mean_true_height_m) > s.expanded_uncertainty_m;
}

std::vector<std::string> methods_of(const CampaignResults& results) {
  std::vector<std::string> methods;
  for (const CellResult& cell : results.cells) {
    if (tells_direction_alone(cell)) continue;  // the figure of directions shows it
    if (std::find(methods.begin(), methods.end(), cell.method) == methods.end())
      methods.push_back(cell.method);
  }
  return in_order(std::move(methods));
}

std::vector<std::string> all_methods_of(const CampaignResults& results) {
  std::vector<std::string> methods = methods_of(results);
  for (const CellResult& cell : results.cells)
    if (std::find(methods.begin(), methods.end(), cell.method) == methods.end())
      methods.push_back(cell.method);
  return methods;
}

double cm(double metres) { return metres / kCentimetre; }

Axis settings_axis(const std::vector<Setting>& settings, bool seas) {
  constexpr std::size_t kMostWithUnits = 8, kMostNamed = 20;  // more would not fit side by side
  const char* const period = seas ? "Set peak period" : "Set period";
  const char* const height = seas ? "Hm0" : "the height";
  Axis axis{.label = fmt::format("{} and {}", period, seas ? "Hm0" : "height")};
  if (settings.size() > kMostNamed) {  // each period once, amid its heights
    axis.label = fmt::format("{} in s; within each {} rises", period, height);
    for (const Setting& s : settings) {
      const std::string name = fmt::format("{:g}", s.period_s);
      if (axis.groups.empty() || axis.groups.back().name != name) axis.groups.push_back({name, 0});
      ++axis.groups.back().places;
    }
    return axis;
  }
  const bool units = settings.size() <= kMostWithUnits;
  if (!units) axis.label = fmt::format("{} in s, below it {} in cm", period, height);
  for (const Setting& s : settings) {
    axis.categories.push_back(units ? fmt::format("{:g} s\n{:g} cm", s.period_s, cm(s.height_m))
                                    : fmt::format("{:g}\n{:g}", s.period_s, cm(s.height_m)));
  }
  return axis;
}

bool are_seas(const CampaignResults& results) {
  std::size_t known = 0, seas = 0;
  for (const CellResult& cell : results.cells) {
    known += std::isfinite(cell.true_hm0_m);
    seas += evaluation::is_sea(cell);
  }
  return known > 0 && 2 * seas > known;
}

Grid::Grid(const std::vector<Setting>& settings) {
  std::set<double> periods, heights;
  for (const Setting& s : settings) {
    periods.insert(s.period_s);
    heights.insert(s.height_m);
  }
  periods_s.assign(periods.begin(), periods.end());
  heights_m.assign(heights.begin(), heights.end());
}

}  // namespace waverig::render
