#include "render/figures/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "motion/kinematics/frames.h"
#include "render/figures/methods.h"
#include "render/marks.h"
#include "render/published.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

using evaluation::CampaignResults;
using evaluation::CellResult;
using evaluation::RunResult;

struct Setting {
  double period_s, height_m;
  auto operator<=>(const Setting&) const = default;
};

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

double cm(double metres) { return metres / kCentimetre; }

std::string setting_name(const Setting& s) {
  return fmt::format("{:g} s\n{:g} cm", s.period_s, cm(s.height_m));
}

Axis settings_axis(const std::vector<Setting>& settings) {
  Axis axis{.label = "Set period and height"};
  for (const Setting& s : settings) axis.categories.push_back(setting_name(s));
  return axis;
}

int color_of_method(std::size_t index) { return static_cast<int>(index); }

// The grid of periods and heights that a campaign spans; a map is drawn on it.
struct Grid {
  std::vector<double> periods_s, heights_m;
  explicit Grid(const std::vector<Setting>& settings) {
    std::set<double> periods, heights;
    for (const Setting& s : settings) {
      periods.insert(s.period_s);
      heights.insert(s.height_m);
    }
    periods_s.assign(periods.begin(), periods.end());
    heights_m.assign(heights.begin(), heights.end());
  }
  template <class Value>
  Panel panel(std::string title, HeatMap map, Value value) const {
    for (std::size_t i = 0; i <= periods_s.size(); ++i) map.x_edges.push_back(static_cast<double>(i) - 0.5);
    for (std::size_t i = 0; i <= heights_m.size(); ++i) map.y_edges.push_back(static_cast<double>(i) - 0.5);
    for (const double height : heights_m) {
      for (const double period : periods_s) map.values.push_back(value(Setting{period, height}));
    }
    Panel panel{.title = std::move(title),
                .x = {.label = "Set period", .unit = "s"},
                .y = {.label = "Set height", .unit = "cm"}};
    for (const double period : periods_s) panel.x.categories.push_back(fmt::format("{:g}", period));
    for (const double height : heights_m) panel.y.categories.push_back(fmt::format("{:g}", cm(height)));
    panel.marks.emplace_back(std::move(map));
    return panel;
  }
};

// A figure of maps, all with the same colour scale.
Figure maps_figure(std::string title, std::string subtitle, std::vector<Panel> panels, double low,
                   double high, const Grid& grid) {
  Figure figure{.title = std::move(title), .subtitle = std::move(subtitle)};
  figure.columns = panels.size() <= 3 ? static_cast<int>(panels.size()) : panels.size() == 4 ? 2 : 3;
  const double rows = std::ceil(static_cast<double>(panels.size()) / std::max(1, figure.columns));
  figure.height_mm = 22 + rows * std::clamp(26 + 9 * static_cast<double>(grid.heights_m.size()), 45.0, 90.0);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    auto& map = std::get<HeatMap>(panels[i].marks.front());
    map.low = low;
    map.high = high;
    // One bar serves a row.
    map.color_bar = (i + 1) % static_cast<std::size_t>(figure.columns) == 0 || i + 1 == panels.size();
    if (i % static_cast<std::size_t>(figure.columns) != 0) panels[i].y.label = panels[i].y.unit = "";
  }
  figure.panels = std::move(panels);
  return figure;
}

struct Spread {
  double n = 0, sum = 0, squares = 0;
  void add(double v) {
    if (!std::isfinite(v)) return;
    ++n;
    sum += v;
    squares += v * v;
  }
  double mean() const { return n > 0 ? sum / n : kAuto; }
  double sigma_of_mean() const {
    return n > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1)) / n) : 0;
  }
};

}  // namespace

std::vector<std::string> methods_of(const CampaignResults& results) {
  std::vector<std::string> methods;
  for (const CellResult& cell : results.cells) {
    if (std::find(methods.begin(), methods.end(), cell.method) == methods.end())
      methods.push_back(cell.method);
  }
  return in_order(std::move(methods));
}

Figure table2_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  Figure figure{.title = "Wave heights: published, and measured on this rig",
                .subtitle = "Lee, Lee, Heo 2014, Table 2, beside campaign \"" + results.name + "\"",
                .share_x = true,
                .height_mm = 130};
  Panel top{.title =
                "(a) Mean less set height, \u00B1 one standard deviation "
                "of single waves",
            .x = settings_axis(settings),
            .y = {.label = "Mean \u2212 set", .unit = "cm"},
            .legend = Legend::kAbove};
  Panel bottom{.title = "(b) Standard deviation of single waves",
               .x = settings_axis(settings),
               .y = {.label = "Standard deviation", .unit = "cm", .scale = Scale::kLog}};
  top.marks.emplace_back(Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});

  const double series = static_cast<double>(methods.size()) + 1, step = 0.8 / series;
  const auto place = [&](std::size_t setting, double index) {
    return static_cast<double>(setting) - 0.4 + (index + 0.5) * step;
  };
  const auto add = [&](const std::string& name, int color, Marker marker, double index, auto mean_m,
                       auto std_m) {
    const Look look{.color = color, .width_pt = 1.1, .marker = marker, .marker_pt = 5};
    Points points{.name = name, .look = look};
    ErrorBars errors{.look = {.color = color, .width_pt = 1.1, .marker_pt = 5}};
    Points spread{.look = look};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const double mean_cm = cm(mean_m(settings[i]) - settings[i].height_m), std_cm = cm(std_m(settings[i]));
      if (!std::isfinite(mean_cm)) continue;
      points.x.push_back(place(i, index));
      points.y.push_back(mean_cm);
      errors.x.push_back(place(i, index));
      errors.y.push_back(mean_cm);
      errors.minus.push_back(std::isfinite(std_cm) ? std_cm : 0);
      errors.plus.push_back(std::isfinite(std_cm) ? std_cm : 0);
      spread.x.push_back(place(i, index));
      spread.y.push_back(std_cm);
    }
    if (points.x.empty()) return;
    top.marks.emplace_back(std::move(errors));
    top.marks.emplace_back(std::move(points));
    bottom.marks.emplace_back(std::move(spread));
  };
  add(
      "published", kFaintInk, Marker::kSquare, 0,
      [](const Setting& s) {
        const auto* c = published_cell(s.period_s, s.height_m);
        return c == nullptr ? kAuto : c->mean_height_m;
      },
      [](const Setting& s) {
        const auto* c = published_cell(s.period_s, s.height_m);
        return c == nullptr ? kAuto : c->std_m;
      });
  static constexpr std::array<Marker, 4> kMarkers = {Marker::kCircle, Marker::kDiamond, Marker::kTriangle,
                                                     Marker::kSquare};
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto of = [&results, &method = methods[m]](const Setting& s, auto member) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : c->statistics.*member;
    };
    add(
        methods[m], color_of_method(m), kMarkers[m % kMarkers.size()], static_cast<double>(m) + 1,
        [&](const Setting& s) { return of(s, &evaluation::HeightStatistics::mean_height_m); },
        [&](const Setting& s) { return of(s, &evaluation::HeightStatistics::std_m); });
  }
  // The limit lies below all of a setting's bars: one stroke across them.
  std::string bound_name = "limit (Cram\u00E9r\u2013Rao)";
  for (std::size_t i = 0; i < settings.size(); ++i) {
    double bound_m = kAuto;
    for (const std::string& method : methods) {
      const CellResult* c = cell_of(results, settings[i], method);
      if (c != nullptr && std::isfinite(c->statistics.bound_std_m)) bound_m = c->statistics.bound_std_m;
    }
    if (!std::isfinite(bound_m)) continue;
    const double x = static_cast<double>(i);
    bottom.marks.emplace_back(Line{.x = {x - 0.42, x + 0.42},
                                   .y = {cm(bound_m), cm(bound_m)},
                                   .name = std::exchange(bound_name, ""),
                                   .look = {.color = kInk, .width_pt = 1.2, .dash = Dash::kDashed}});
  }
  bottom.legend = Legend::kAbove;
  figure.panels = {std::move(top), std::move(bottom)};
  return figure;
}

Figure error_map_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  std::vector<Panel> panels;
  double most = 0;
  for (const std::string& method : methods_of(results)) {
    const auto value = [&](const Setting& s) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : 100 * (c->statistics.mean_height_m - s.height_m) / s.height_m;
    };
    for (const Setting& s : settings)
      if (std::isfinite(value(s))) most = std::max(most, std::abs(value(s)));
    panels.push_back(grid.panel(
        method, {.label = "Error of the mean", .unit = "%", .map = ColorMap::kDiverging, .decimals = 2},
        value));
  }
  return maps_figure("Error of the mean wave height",
                     "mean less set height, in percent of the set height; one "
                     "colour scale for all methods",
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
      panels.push_back(grid.panel(
          title, {.label = "Standard deviation", .unit = "cm", .log_colors = true, .decimals = 2}, value));
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
  return maps_figure("Standard deviation of single waves",
                     "over the waves of all repeats; logarithmic colours, one "
                     "scale for all maps",
                     std::move(panels), low, high, grid);
}

Figure frequency_response_figure(const CampaignResults& results) {
  Figure figure{.title = "Frequency response",
                .subtitle =
                    "mean over the runs of a period; bands and bars: k "
                    "= 2 standard uncertainties of the mean",
                .share_x = true,
                .height_mm = 120};
  const Axis period{.label = "Wave period", .unit = "s", .padding = 0.08};
  Panel gain{.title = "(a) Gain: estimated over true wave height",
             .x = period,
             .y = {.label = "Gain"},
             .legend = Legend::kAbove};
  Panel phase{.title = "(b) Phase: estimated against true heave",
              .x = period,
              .y = {.label = "Phase", .unit = "\u00B0"}};
  gain.marks.emplace_back(
      Rule{.at = 1, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kDashed}});
  phase.marks.emplace_back(
      Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kDashed}});
  const std::vector<std::string> methods = methods_of(results);
  const auto add = [](Panel& panel, const std::map<double, Spread>& by_period, const std::string& name,
                      int color) {
    Line line{.name = name, .look = {.color = color, .marker = Marker::kCircle, .marker_pt = 4}};
    Band band{.look = {.color = color, .alpha = 0.18}};
    ErrorBars bars{.look = {.color = color, .width_pt = 0.8}};
    for (const auto& [period_s, spread] : by_period) {
      if (spread.n < 1) continue;
      const double u = 2 * spread.sigma_of_mean();
      line.x.push_back(period_s);
      line.y.push_back(spread.mean());
      band.x.push_back(period_s);
      band.low.push_back(spread.mean() - u);
      band.high.push_back(spread.mean() + u);
      bars.minus.push_back(u);
      bars.plus.push_back(u);
    }
    if (line.x.empty()) return;
    bars.x = line.x;
    bars.y = line.y;
    panel.marks.emplace_back(std::move(band));
    panel.marks.emplace_back(std::move(bars));
    panel.marks.emplace_back(std::move(line));
  };
  std::string without_phase;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::map<double, Spread> gains, phases;
    for (const RunResult& run : results.runs) {
      if (run.method != methods[m]) continue;
      const evaluation::HeightStatistics& s = run.statistics;
      const double ratio = s.waves > 0 ? s.mean_height_m / s.mean_true_height_m : run.heave_gain;
      gains[run.period_s].add(ratio);
      // A trace that ran away from the truth has no phase.
      if (run.heave_rmse_m < 0.25 * run.height_m)
        phases[run.period_s].add(-360 * run.heave_lag_s / run.period_s);
    }
    add(gain, gains, methods[m], color_of_method(m));
    add(phase, phases, methods[m], color_of_method(m));
    if (phases.empty()) without_phase += (without_phase.empty() ? "" : ", ") + methods[m];
  }
  if (!without_phase.empty())
    phase.marks.emplace_back(Note{.x = 0.01,
                                  .y = 0.97,
                                  .text = "no phase, for its heave drifts: " + without_phase,
                                  .color = kFaintInk});
  figure.panels = {std::move(gain), std::move(phase)};
  return figure;
}

Figure single_waves_figure(const CampaignResults& results) {
  constexpr std::size_t kMostSlots =
      12;  // settings side by side; more, and errors stand over the true height
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  const bool slots = settings.size() <= kMostSlots;
  Figure figure{.title = "Single waves, estimated against true", .columns = 3, .height_mm = 95};
  Panel against{.title = "(a) Against true height",
                .x = {.label = "True height", .unit = "cm"},
                .y = {.label = "Estimated height", .unit = "cm"}};
  Panel residual{.title = slots ? "(b) Estimated less true, wave after wave" : "(b) Estimated less true",
                 .y = {.label = "Estimated \u2212 true", .unit = "cm"},
                 .legend = Legend::kNone,
                 .column_span = 2};
  residual.x = slots ? settings_axis(settings) : Axis{.label = "True height", .unit = "cm"};
  residual.marks.emplace_back(
      Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});
  Extent heights;
  std::size_t waves = 0;
  const double slot = 0.84 / static_cast<double>(std::max<std::size_t>(1, methods.size()));
  for (std::size_t m = 0; m < methods.size(); ++m) {
    Points points{
        .name = methods[m],
        .look = {.color = color_of_method(m), .marker = Marker::kCircle, .marker_pt = 2.4, .alpha = 0.55}};
    Points errors{.look = points.look};
    std::vector<double> counted(settings.size(), 0.0), placed(settings.size(), 0.0);
    const auto place_of = [&](const RunResult& run) {
      return static_cast<std::size_t>(
          std::find(settings.begin(), settings.end(), Setting{run.period_s, run.height_m}) -
          settings.begin());
    };
    for (const RunResult& run : results.runs)
      if (run.method == methods[m] && place_of(run) < settings.size())
        counted[place_of(run)] += static_cast<double>(run.waves.size());
    for (const RunResult& run : results.runs) {
      const std::size_t place = place_of(run);
      if (run.method != methods[m] || place >= settings.size()) continue;
      for (const evaluation::JudgedWave& wave : run.waves) {
        const double along = (placed[place]++ + 0.5) / counted[place];  // the waves of a setting fill its
                                                                        // slot in their order
        const double true_cm = cm(wave.true_height_m), estimated_cm = cm(wave.wave.height_m);
        if (!std::isfinite(true_cm + estimated_cm)) continue;
        heights.add(true_cm);
        ++waves;
        points.x.push_back(true_cm);
        points.y.push_back(estimated_cm);
        errors.x.push_back(slots ? static_cast<double>(place) - 0.42 +
                                       slot * (static_cast<double>(m) + 0.05 + 0.9 * along)
                                 : true_cm);
        errors.y.push_back(estimated_cm - true_cm);
      }
    }
    if (points.x.empty()) continue;
    against.marks.emplace_back(std::move(points));
    residual.marks.emplace_back(std::move(errors));
  }
  if (!heights.empty()) {
    const double room = 0.08 * (heights.high - heights.low) + 1;
    against.marks.emplace_back(Line{.x = {heights.low - room, heights.high + room},
                                    .y = {heights.low - room, heights.high + room},
                                    .name = "equal",
                                    .look = {.color = kInk, .width_pt = 0.8, .dash = Dash::kDashed}});
  }
  figure.subtitle = fmt::format("{} waves of all runs, ramps left out", waves);
  figure.panels = {std::move(against), std::move(residual)};
  return figure;
}

Figure uncertainty_budget_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  Figure figure{.title = "Uncertainty budget of the mean wave height",
                .subtitle =
                    "standard uncertainties (k = 1) after the GUM; A: "
                    "from repeats, B: from knowledge beforehand",
                .columns = 1};
  std::size_t rows = 0;
  // The settings that span the campaign: at most four, or the bars become
  // hairs.
  std::vector<Setting> shown;
  if (settings.size() <= 4)
    shown = settings;
  else {
    const Grid grid(settings);
    for (const double period : {grid.periods_s.front(), grid.periods_s.back()}) {
      for (const double height : {grid.heights_m.front(), grid.heights_m.back()}) {
        const Setting s{period, height};
        if (std::find(settings.begin(), settings.end(), s) != settings.end() &&
            std::find(shown.begin(), shown.end(), s) == shown.end())
          shown.push_back(s);
      }
    }
  }
  for (const std::string& method : methods) {
    std::vector<std::string> names;
    for (const Setting& s : shown) {
      const CellResult* c = cell_of(results, s, method);
      if (c == nullptr) continue;
      for (const evaluation::Contribution& part : c->statistics.budget) {
        const std::string name = fmt::format("{} ({})", part.name, part.type);
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
    if (names.empty()) continue;
    names.emplace_back("combined");
    Panel panel{.title = method,
                .x = {.label = "Standard uncertainty of the mean height", .unit = "mm"},
                .legend = Legend::kAbove};
    panel.y.categories.assign(names.rbegin(), names.rend());  // the first on top
    const double step = 0.8 / static_cast<double>(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const CellResult* c = cell_of(results, shown[i], method);
      if (c == nullptr || c->statistics.budget.empty()) continue;
      Bars bars{.name = fmt::format("{:g} s, {:g} cm", shown[i].period_s, cm(shown[i].height_m)),
                .look = {.color = static_cast<int>(i)},
                .width = 0.9 * step,
                .horizontal = true};
      const auto add = [&](const std::string& name, double sigma_m) {
        const auto at =
            static_cast<double>(std::find(panel.y.categories.begin(), panel.y.categories.end(), name) -
                                panel.y.categories.begin());
        bars.at.push_back(at + 0.4 - (static_cast<double>(i) + 0.5) * step);
        bars.value.push_back(1000 * sigma_m);
      };
      double square = 0;
      for (const evaluation::Contribution& part : c->statistics.budget) {
        add(fmt::format("{} ({})", part.name, part.type), part.sigma_m);
        square += part.sigma_m * part.sigma_m;
      }
      add("combined", std::sqrt(square));
      panel.marks.emplace_back(std::move(bars));
    }
    if (!figure.panels.empty()) panel.legend = Legend::kNone;
    rows += names.size();
    figure.row_heights.push_back(static_cast<double>(names.size()));
    figure.panels.push_back(std::move(panel));
  }
  figure.height_mm = std::clamp(
      30 + 24 * static_cast<double>(figure.panels.size()) + 6.5 * static_cast<double>(rows), 60.0, 240.0);
  return figure;
}

}  // namespace waverig::render
