// The settings of a campaign, as its figures go through them.
#pragma once
#include <compare>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"
#include "render/figure.h"

namespace waverig::render {

struct Setting {
  double period_s, height_m;
  auto operator<=>(const Setting&) const = default;
};

std::vector<Setting> settings_of(const evaluation::CampaignResults& results);  // by period, then height
// The row of a setting and method, or nullptr.
const evaluation::CellResult* cell_of(const evaluation::CampaignResults& results, const Setting& setting,
                                      const std::string& method);
// A cell that has no place in tables and figures of heights and heave.
bool tells_direction_alone(const evaluation::CellResult& cell);
// Whether the mean height is further from the true one than its expanded uncertainty covers.
bool is_beyond_uncertainty(const evaluation::HeightStatistics& s);
// Methods as every figure of heights and heave shows them: the palette number of each is its place here.
std::vector<std::string> methods_of(const evaluation::CampaignResults& results);
// The same, and behind them those that tell directions alone.
std::vector<std::string> all_methods_of(const evaluation::CampaignResults& results);

// One category each, or where there is no room for their names, a group a period. seas: the heights are Hm0.
Axis settings_axis(const std::vector<Setting>& settings, bool seas);

// Whether the set heights are Hm0 of irregular seas, in most cells.
bool are_seas(const evaluation::CampaignResults& results);

double cm(double metres);

// The grid of periods and heights that a campaign spans.
struct Grid {
  std::vector<double> periods_s, heights_m;
  explicit Grid(const std::vector<Setting>& settings);
};

}  // namespace waverig::render
