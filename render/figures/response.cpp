#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "render/figures/accuracy.h"
#include "render/figures/methods.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::RunResult;

namespace {

struct Spread {
  double n = 0, sum = 0, squares = 0;
  void add(double v) {
    if (!std::isfinite(v)) return;
    ++n;
    sum += v;
    squares += v * v;
  }
  double mean() const { return n > 0 ? sum / n : kAuto; }
  // Unknown of a single one.
  double deviation() const {
    return n > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1))) : kAuto;
  }
};

// A trace that ran away from the truth has neither gain nor phase: least squares would tell its drift.
bool follows(const RunResult& run) { return run.heave_rmse_m < 0.25 * run.height_m; }

double gain_of(const RunResult& run) {
  const evaluation::HeightStatistics& s = run.statistics;
  if (s.waves > 0) return s.mean_height_m / s.mean_true_height_m;
  return follows(run) ? run.heave_gain : kAuto;
}

double phase_deg(const RunResult& run) {
  return follows(run) ? -360 * run.heave_lag_s / run.period_s : kAuto;
}

// What the points and bars are; of a period with a single run there is no bar to be explained.
std::string subtitle_of(const CampaignResults& results, bool heights_differ) {
  std::map<std::pair<double, std::string>, int> runs;  // of a period and method
  int most = 0;
  for (const RunResult& run : results.runs) most = std::max(most, ++runs[{run.period_s, run.method}]);
  if (most < 2) return "a single run of each period: its scatter is unknown";
  return std::string("mean over the runs of a period; bars: standard deviation between those runs") +
         (heights_differ ? ", which differ in height" : "");
}

}  // namespace

Figure frequency_response_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  Figure figure{.title = "Frequency response",
                .subtitle = subtitle_of(results, settings.size() > grid.periods_s.size()),
                .share_x = true,
                .height_mm = 120};
  Axis period{.label = are_seas(results) ? "Set peak period" : "Wave period", .unit = "s", .padding = 0.08};
  // A single period has no neighbours to be drawn to scale with.
  const bool single = grid.periods_s.size() == 1;
  if (single) period.categories = {fmt::format("{:g}", grid.periods_s.front())};
  Panel gain{.title = "(a) Gain: estimated over true wave height",
             .x = period,
             .y = {.label = "Gain"},
             .legend = Legend::kAbove};
  Panel phase{.title = "(b) Phase: estimated against true heave",
              .x = period,
              .y = {.label = "Phase", .unit = "\u00B0"},
              .legend = Legend::kNone};
  gain.marks.emplace_back(
      Rule{.at = 1, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kDashed}});
  phase.marks.emplace_back(
      Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kDashed}});
  const std::vector<std::string> methods = methods_of(results);
  const auto add = [single](Panel& panel, const std::map<double, Spread>& by_period, const std::string& name,
                            int color) {
    Line line{.name = name, .look = {.color = color, .marker = Marker::kCircle, .marker_pt = 4}};
    ErrorBars bars{.look = {.color = color, .width_pt = 0.8}};
    for (const auto& [period_s, spread] : by_period) {
      line.x.push_back(single ? 0 : period_s);
      line.y.push_back(spread.mean());  // unknown where no run tells it: the line breaks
      bars.minus.push_back(spread.deviation());
      bars.plus.push_back(spread.deviation());
    }
    bars.x = line.x;
    bars.y = line.y;
    const bool any = std::ranges::any_of(line.y, [](double y) { return std::isfinite(y); });
    if (any) {
      panel.marks.emplace_back(std::move(bars));
      panel.marks.emplace_back(std::move(line));
    }
    return any;
  };
  std::string without_phase;
  bool any = false;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::map<double, Spread> gains, phases;
    for (const RunResult& run : results.runs) {
      if (run.method != methods[m]) continue;
      gains[run.period_s].add(gain_of(run));
      phases[run.period_s].add(phase_deg(run));
    }
    any |= add(gain, gains, methods[m], static_cast<int>(m));
    const bool has_phase = add(phase, phases, methods[m], static_cast<int>(m));
    any |= has_phase;
    if (!has_phase) without_phase += (without_phase.empty() ? "" : ", ") + methods[m];
  }
  if (!any) return figure;
  if (!without_phase.empty())
    phase.marks.emplace_back(Note{.x = 0.01,
                                  .y = 0.97,
                                  .text = "no phase, for its heave drifts or is not told: " + without_phase,
                                  .color = kFaintInk});
  for (Panel* panel : {&gain, &phase}) draw_same_once(panel->marks);
  figure.panels = {std::move(gain), std::move(phase)};
  return figure;
}

}  // namespace waverig::render
