#include "render/figures/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

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

std::vector<std::string> methods_of(const CampaignResults& results) {
  std::vector<std::string> methods;
  for (const CellResult& cell : results.cells) {
    if (std::find(methods.begin(), methods.end(), cell.method) == methods.end())
      methods.push_back(cell.method);
  }
  return in_order(std::move(methods));
}

double cm(double metres) { return metres / kCentimetre; }

Axis settings_axis(const std::vector<Setting>& settings) {
  Axis axis{.label = "Set period and height"};
  for (const Setting& s : settings)
    axis.categories.push_back(fmt::format("{:g} s\n{:g} cm", s.period_s, cm(s.height_m)));
  return axis;
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
