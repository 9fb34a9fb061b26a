#include "render/figures/sea.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/figures/methods.h"
#include "render/figures/run_time.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

constexpr std::array<Marker, 4> kMarkers = {Marker::kCircle, Marker::kDiamond, Marker::kTriangle,
                                            Marker::kSquare};

// The true heave at a time between two samples; unknown outside the record.
double true_heave_m(const evaluation::RunRecord& run, std::int64_t utime) {
  const auto after =
      std::upper_bound(run.truth.begin(), run.truth.end(), utime,
                       [](std::int64_t t, const evaluation::TruthSample& s) { return t < s.utime; });
  if (after == run.truth.begin() || after == run.truth.end()) return kAuto;
  const evaluation::TruthSample& before = *(after - 1);
  const double share =
      static_cast<double>(utime - before.utime) / static_cast<double>(after->utime - before.utime);
  return before.heave_m + share * (after->heave_m - before.heave_m);
}

}  // namespace

Figure sea_states_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  Figure figure{.title = "Sea states: measured against true",
                .subtitle = "campaign \"" + results.name + "\"",
                .share_x = true,
                .height_mm = 165};
  Panel heave{.title = "(a) RMS error of the heave",
              .x = settings_axis(settings, true),
              .y = {.label = "Error", .unit = "% of Hm0", .scale = Scale::kLog},
              .legend = Legend::kAbove};
  const auto error_panel = [&](const char* title) {
    Panel panel{.title = title, .x = heave.x, .y = {.label = "Error", .unit = "%"}, .legend = Legend::kNone};
    panel.marks.emplace_back(
        Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});
    return panel;
  };
  Panel height = error_panel("(b) Hm0, measured less true"),
        period = error_panel("(c) Tm02, measured less true");
  const double step = 0.7 / static_cast<double>(std::max<std::size_t>(1, methods.size()));
  const auto place = [&](std::size_t setting, std::size_t method) {
    return static_cast<double>(setting) - 0.35 + (static_cast<double>(method) + 0.5) * step;
  };
  bool any = false;
  std::string without_sea, bound_name = "bound (Wiener)";
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto add = [&](Panel& panel, auto value) {
      Points points{
          .name = methods[m],
          .look = {.color = static_cast<int>(m), .marker = kMarkers[m % kMarkers.size()], .marker_pt = 5}};
      for (std::size_t i = 0; i < settings.size(); ++i) {
        const CellResult* cell = cell_of(results, settings[i], methods[m]);
        const double y = cell == nullptr ? kAuto : value(*cell);
        if (!std::isfinite(y)) continue;
        points.x.push_back(place(i, m));
        points.y.push_back(y);
      }
      if (points.x.empty()) return false;
      panel.marks.emplace_back(std::move(points));
      return any = true;
    };
    // Of each method by its own lag: what no other could undercut.
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const CellResult* cell = cell_of(results, settings[i], methods[m]);
      const double bound = cell == nullptr ? kAuto : 100 * cell->heave_bound_m / cell->true_hm0_m;
      if (!std::isfinite(bound)) continue;
      heave.marks.emplace_back(Line{.x = {place(i, m) - 0.45 * step, place(i, m) + 0.45 * step},
                                    .y = {bound, bound},
                                    .name = std::exchange(bound_name, ""),
                                    .look = {.color = kInk, .width_pt = 1.2}});
    }
    add(heave, [](const CellResult& c) { return 100 * c.heave_rmse_m / c.true_hm0_m; });
    const bool has_sea =
        add(height, [](const CellResult& c) { return 100 * (c.sea.sea.hm0_m / c.sea.true_hm0_m - 1); });
    ErrorBars stated{.look = {.color = static_cast<int>(m), .width_pt = 0.8}};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const CellResult* cell = cell_of(results, settings[i], methods[m]);
      if (cell == nullptr || !std::isfinite(cell->sea.sea.hm0_sigma_m)) continue;
      const estimator::SeaState& sea = cell->sea.sea;
      stated.x.push_back(place(i, m));
      stated.y.push_back(100 * (sea.hm0_m / cell->sea.true_hm0_m - 1));
      stated.minus.push_back(200 * sea.hm0_sigma_m / cell->sea.true_hm0_m);
      stated.plus.push_back(stated.minus.back());
    }
    if (!stated.x.empty()) {
      height.title = "(b) Hm0, measured less true, \u00B1 two standard uncertainties where stated";
      height.marks.emplace_back(std::move(stated));
    }
    add(period, [](const CellResult& c) { return 100 * (c.sea.sea.tm02_s / c.sea.true_tm02_s - 1); });
    if (!has_sea) without_sea += (without_sea.empty() ? "" : ", ") + methods[m];
  }
  if (!any) return figure;
  if (bound_name.empty())
    figure.subtitle += "; bound: the least to be expected, a single record may fall below";
  if (!without_sea.empty()) {
    height.marks.emplace_back(
        Note{.x = 0.01, .y = 0.97, .text = "gives no sea state: " + without_sea, .color = kFaintInk});
    height.y.padding = 0.2;
  }
  figure.panels = {std::move(heave), std::move(height), std::move(period)};
  return figure;
}

Figure sea_trace_figure(const evaluation::RunRecord& run, const std::vector<std::string>& methods) {
  constexpr double kShownPeriods = 12;
  const double begin_s = since_start_s(run, run.steady_begin_utime),
               end_s = since_start_s(run, run.steady_end_utime);
  const double shown_s = std::min(kShownPeriods * run.period_s, end_s - begin_s);
  const double from_s = 0.5 * (begin_s + end_s - shown_s), to_s = from_s + shown_s;
  Figure figure{.title = "Heave on an irregular sea", .subtitle = setting_text(run), .height_mm = 130};
  Panel trace{.title = "(a) Some waves",
              .x = {.label = "Time since the start of the record", .unit = "s", .low = from_s, .high = to_s},
              .y = {.label = "Heave", .unit = "cm"},
              .legend = Legend::kAbove};
  Panel error{
      .title = "(b) Estimated less true, the whole steady part",
      .x = {.label = "Time since the start of the record", .unit = "s", .low = begin_s, .high = end_s},
      .y = {.label = "Error", .unit = "cm"},
      .legend = Legend::kNone};
  const auto is_shown = [&](double t) { return t >= from_s && t <= to_s; };
  for (const std::string& method : heave_methods_of(run)) {
    const int color = method_color(methods, method);
    Line shown{.name = method, .look = {.color = color, .width_pt = 1.1}},
        off{.look = {.color = color, .width_pt = 0.8}};
    double sum_cm = 0;
    for (const estimator::HeaveSample& sample : run.heave.at(method)) {
      const double t = since_start_s(run, sample.utime);
      const double error_cm = cm(sample.heave_m - true_heave_m(run, sample.utime));
      if (t < begin_s || t > end_s || !std::isfinite(error_cm)) continue;
      off.x.push_back(t);
      off.y.push_back(error_cm);
      sum_cm += error_cm;
      if (!is_shown(t)) continue;
      shown.x.push_back(t);
      shown.y.push_back(cm(sample.heave_m));
    }
    if (off.x.empty()) continue;
    const double mean_cm = sum_cm / static_cast<double>(off.x.size());
    for (double& y : off.y) y -= mean_cm;
    for (double& y : shown.y) y -= mean_cm;
    trace.marks.emplace_back(std::move(shown));
    error.marks.emplace_back(std::move(off));
  }
  for (Panel* panel : {&trace, &error}) draw_same_once(panel->marks);
  Line truth{.name = "truth", .look = {.color = kInk, .width_pt = 1.1, .dash = Dash::kDashed}};
  for (const evaluation::TruthSample& sample : run.truth) {
    const double t = since_start_s(run, sample.utime);
    if (!is_shown(t)) continue;
    truth.x.push_back(t);
    truth.y.push_back(cm(sample.heave_m));
  }
  trace.marks.emplace_back(std::move(truth));
  figure.panels = {std::move(trace), std::move(error)};
  return figure;
}

}  // namespace waverig::render
