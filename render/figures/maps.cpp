#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/accuracy.h"
#include "render/figures/sea.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

constexpr double kKnee = 1;  // percent: one outlier leaves the small errors their colours

template <class Value>
Panel map_panel(const Grid& grid, std::string title, HeatMap map, Value value) {
  for (std::size_t i = 0; i <= grid.periods_s.size(); ++i)
    map.x_edges.push_back(static_cast<double>(i) - 0.5);
  for (std::size_t i = 0; i <= grid.heights_m.size(); ++i)
    map.y_edges.push_back(static_cast<double>(i) - 0.5);
  for (const double height : grid.heights_m) {
    for (const double period : grid.periods_s) map.values.push_back(value(Setting{period, height}));
  }
  Panel panel{.title = std::move(title),
              .x = {.label = "Set period", .unit = "s"},
              .y = {.label = "Set height", .unit = "cm"}};
  for (const double period : grid.periods_s) panel.x.categories.push_back(fmt::format("{:g}", period));
  for (const double height : grid.heights_m) panel.y.categories.push_back(fmt::format("{:g}", cm(height)));
  panel.marks.emplace_back(std::move(map));
  return panel;
}

// A figure of maps, all with the same colour scale.
Figure maps_figure(std::string title, std::string subtitle, std::vector<Panel> panels, double low,
                   double high, const Grid& grid) {
  Figure figure{.title = std::move(title), .subtitle = std::move(subtitle)};
  // No more side by side than leave room for the numbers.
  std::size_t most = 3;
  if (grid.periods_s.size() > 5 || panels.size() == 4) most = 2;
  if (grid.periods_s.size() > 6) most = 1;
  figure.columns = static_cast<int>(std::min(panels.size(), most));
  const bool wide = figure.columns == 1;
  const double rows = std::ceil(static_cast<double>(panels.size()) / std::max(1, figure.columns));
  const double heights = static_cast<double>(grid.heights_m.size());
  // However few the rows, the names of axis and colour bar stand beside them.
  figure.height_mm =
      22 + rows * (wide ? std::max(34.0, 20 + 6 * heights) : std::clamp(26 + 9 * heights, 45.0, 90.0));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    auto& map = std::get<HeatMap>(panels[i].marks.front());
    map.low = low;
    map.high = high;
    // One bar serves them all, at the right end of the first row.
    map.color_bar = i + 1 == std::min(panels.size(), static_cast<std::size_t>(figure.columns));
    if (i % static_cast<std::size_t>(figure.columns) != 0) panels[i].y.label = panels[i].y.unit = "";
  }
  figure.panels = std::move(panels);
  return figure;
}

}  // namespace

Figure error_map_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  std::vector<Panel> panels;
  double most = 0;
  bool any_beyond = false;
  for (const std::string& method : methods_of(results)) {
    const auto value = [&](const Setting& s) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : c->statistics.mean_error_percent;
    };
    for (const Setting& s : settings)
      if (std::isfinite(value(s))) most = std::max(most, std::abs(value(s)));
    HeatMap map{.label = "Error", .unit = "%", .map = ColorMap::kDiverging, .knee = kKnee, .decimals = 2};
    for (const double height_m : grid.heights_m) {
      for (const double period_s : grid.periods_s) {
        const CellResult* c = cell_of(results, {period_s, height_m}, method);
        const bool is_beyond = c != nullptr && is_beyond_uncertainty(c->statistics);
        map.signs.emplace_back(is_beyond ? "*" : "");
        any_beyond |= is_beyond;
      }
    }
    panels.push_back(map_panel(grid, method, std::move(map), value));
  }
  return maps_figure(
      "Error of the mean wave height",
      fmt::format(
          "mean less true height, in percent of the true height; one colour scale for all methods{}{}",
          most > kKnee ? fmt::format(", logarithmic beyond {:g} %", kKnee) : "",
          any_beyond ? "\n* further off than the expanded uncertainty (k = 2)" : ""),
      std::move(panels), -most, most, grid);
}

Figure std_map_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  std::vector<Panel> panels;
  double low = 1e9, high = 0;
  const auto add = [&](const std::string& title, auto value) {
    bool found = false;
    for (const Setting& s : settings) {
      if (const double v = value(s); std::isfinite(v) && v > 0) {
        low = std::min(low, v);
        high = std::max(high, v);
        found = true;
      }
    }
    if (found)
      panels.push_back(
          map_panel(grid, title, {.label = "Std", .unit = "cm", .log_colors = true, .decimals = 3}, value));
  };
  const std::vector<std::string> methods = methods_of(results);
  for (const std::string& method : methods) {
    add(method, [&](const Setting& s) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : cm(c->statistics.std_m);
    });
  }
  add("limit (Cram\u00E9r\u2013Rao)", [&](const Setting& s) {
    for (const std::string& method : methods) {
      const CellResult* c = cell_of(results, s, method);
      if (c != nullptr && std::isfinite(c->statistics.bound_std_m)) return cm(c->statistics.bound_std_m);
    }
    return kAuto;
  });
  return maps_figure(
      "Standard deviation of single waves",
      "over the waves of all repeats; logarithmic colours, one scale for all maps; the limit is that of a "
      "wave by itself, without what its neighbours tell",
      std::move(panels), low, high, grid);
}

Figure sea_heave_map_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  std::vector<Panel> panels;
  double low = 1e9, high = 0;
  for (const std::string& method : methods_of(results)) {
    const auto value = [&](const Setting& s) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : 100 * c->heave_rmse_m / c->true_hm0_m;
    };
    for (const Setting& s : settings) {
      if (const double v = value(s); std::isfinite(v) && v > 0) {
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
    panels.push_back(map_panel(
        grid, method, {.label = "Error", .unit = "% of Hm0", .log_colors = true, .decimals = 3}, value));
    panels.back().x.label = "Set peak period";
    panels.back().y.label = "Set Hm0";
  }
  return maps_figure(
      "Error of the heave on irregular seas",
      "root mean square in percent of the true Hm0; logarithmic colours, one scale for all maps",
      std::move(panels), low, high, grid);
}

}  // namespace waverig::render
