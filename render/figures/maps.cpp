#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/accuracy.h"
#include "render/figures/sea.h"
#include "render/figures/settings.h"
#include "render/marks.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

constexpr double kKnee = 1;             // percent: one outlier leaves the small errors their colours
constexpr std::int64_t kFewWaves = 10;  // fewer say little of a mean, and less of a scatter
constexpr const char *kNothing = "\u2013", *kFew = "\u2020", *kBeyond = "*";

// Maps of one quantity, a method each. Methods that tell it in no setting have none: they are named.
struct Maps {
  const CampaignResults& results;
  std::vector<Setting> settings = settings_of(results);
  Grid grid{settings};
  std::vector<Panel> panels{};
  Extent extent{};
  std::string without{};

  // value of a cell, and signs behind it; the first of `methods` that tells one stands for a setting.
  template <class Value, class Signs>
  void add(const std::string& title, const std::vector<std::string>& methods, HeatMap map, Value value,
           Signs signs) {
    for (std::size_t i = 0; i <= grid.periods_s.size(); ++i)
      map.x_edges.push_back(static_cast<double>(i) - 0.5);
    for (std::size_t i = 0; i <= grid.heights_m.size(); ++i)
      map.y_edges.push_back(static_cast<double>(i) - 0.5);
    Extent told;
    Line not_run{.look = {.color = kFaintInk, .width_pt = 0.6}};
    for (std::size_t r = 0; r < grid.heights_m.size(); ++r) {
      for (std::size_t c = 0; c < grid.periods_s.size(); ++c) {
        const Setting s{grid.periods_s[c], grid.heights_m[r]};
        const bool ran = std::ranges::find(settings, s) != settings.end();
        double v = kAuto;
        std::string sign = ran ? kNothing : "";
        for (const std::string& method : methods) {
          const CellResult* cell = cell_of(results, s, method);
          if (cell == nullptr || !fits(value(*cell), map.log_colors ? Scale::kLog : Scale::kLinear)) continue;
          v = value(*cell);
          sign = signs(*cell);
          break;
        }
        told.add(v);
        map.values.push_back(v);
        map.signs.push_back(std::move(sign));
        if (ran) continue;
        const auto x = static_cast<double>(c), y = static_cast<double>(r);
        not_run.x.insert(not_run.x.end(), {x - 0.5, x + 0.5, kAuto});
        not_run.y.insert(not_run.y.end(), {y - 0.5, y + 0.5, kAuto});
      }
    }
    if (told.empty()) {
      without += (without.empty() ? "" : ", ") + title;
      return;
    }
    extent.add(told);
    Panel panel{.title = title,
                .x = {.label = "Set period", .unit = "s"},
                .y = {.label = "Set height", .unit = "cm"}};
    for (const double period : grid.periods_s) panel.x.categories.push_back(fmt::format("{:g}", period));
    for (const double height : grid.heights_m) panel.y.categories.push_back(fmt::format("{:g}", cm(height)));
    panel.marks.emplace_back(std::move(map));
    if (!not_run.x.empty()) panel.marks.emplace_back(std::move(not_run));
    panels.push_back(std::move(panel));
  }

  // What the signs mean that occur, and what is missing: a line of the subtitle.
  std::string legend(const char* nothing) const {
    const auto occurs = [&](std::string_view sign) {
      return std::ranges::any_of(panels, [&](const Panel& panel) {
        return std::ranges::any_of(std::get<HeatMap>(panel.marks.front()).signs,
                                   [&](const std::string& s) { return s.find(sign) != std::string::npos; });
      });
    };
    std::string text;
    const auto say = [&](bool needed, const std::string& words) {
      if (needed) text += (text.empty() ? "\n" : "; ") + words;
    };
    say(occurs(kBeyond), fmt::format("{} beyond the expanded uncertainty (k = 2)", kBeyond));
    say(occurs(kFew), fmt::format("{} fewer than {} waves", kFew, kFewWaves));
    say(occurs(kNothing), fmt::format("{} {}", kNothing, nothing));
    say(!panels.empty() && panels.front().marks.size() > 1, "struck out: not run");
    say(!without.empty(), fmt::format("{} in any setting: {}", nothing, without));
    return text;
  }
};

std::string few_sign(const CellResult& cell) { return cell.statistics.waves < kFewWaves ? kFew : ""; }
std::string no_sign(const CellResult&) { return ""; }

// A figure of maps, all with the same colour scale.
Figure maps_figure(std::string title, std::string subtitle, Maps maps, double low, double high) {
  const Grid& grid = maps.grid;
  std::vector<Panel>& panels = maps.panels;
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
  Maps maps{results};
  for (const std::string& method : methods_of(results))
    maps.add(
        method, {method},
        {.label = "Error", .unit = "%", .map = ColorMap::kDiverging, .knee = kKnee, .decimals = 2},
        [](const CellResult& c) { return c.statistics.mean_error_percent; },
        [](const CellResult& c) {
          return fmt::format("{}{}", is_beyond_uncertainty(c.statistics) ? kBeyond : "", few_sign(c));
        });
  const double most = std::max(std::abs(maps.extent.low), std::abs(maps.extent.high));
  const std::string subtitle = fmt::format(
      "mean less true height, in percent of the true height; one colour scale for all methods{}{}",
      most > kKnee ? fmt::format(", logarithmic beyond {:g} %", kKnee) : "", maps.legend("no wave measured"));
  return maps_figure("Error of the mean wave height", subtitle, std::move(maps), -most, most);
}

Figure std_map_figure(const CampaignResults& results) {
  Maps maps{results};
  const std::vector<std::string> methods = methods_of(results);
  const HeatMap look{.label = "Std", .unit = "cm", .log_colors = true, .decimals = 3};
  for (const std::string& method : methods)
    maps.add(
        method, {method}, look, [](const CellResult& c) { return cm(c.statistics.std_m); }, few_sign);
  const std::string legend = maps.legend("fewer than two waves");
  if (!maps.panels.empty())  // nothing to hold against it otherwise
    maps.add(
        "bound (Cram\u00E9r\u2013Rao)", methods, look,
        [](const CellResult& c) { return cm(c.statistics.bound_std_m); }, no_sign);
  const double low = maps.extent.low, high = maps.extent.high;
  return maps_figure(
      "Standard deviation of single waves",
      "over the waves of all repeats; logarithmic colours, one scale for all maps; the bound is that of a "
      "wave by itself, without what its neighbours tell" +
          legend,
      std::move(maps), low, high);
}

Figure sea_heave_map_figure(const CampaignResults& results) {
  Maps maps{results};
  for (const std::string& method : methods_of(results))
    maps.add(
        method, {method}, {.label = "Error", .unit = "% of Hm0", .log_colors = true, .decimals = 3},
        [](const CellResult& c) { return 100 * c.heave_rmse_m / c.true_hm0_m; }, no_sign);
  for (Panel& panel : maps.panels) {
    panel.x.label = "Set peak period";
    panel.y.label = "Set Hm0";
  }
  const double low = maps.extent.low, high = maps.extent.high;
  const std::string legend = maps.legend("no heave told");
  return maps_figure(
      "Error of the heave on irregular seas",
      "root mean square in percent of the true Hm0; logarithmic colours, one scale for all maps" + legend,
      std::move(maps), low, high);
}

}  // namespace waverig::render
