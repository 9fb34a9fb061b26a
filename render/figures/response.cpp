#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <string>
#include <utility>

#include "render/figures/accuracy.h"
#include "render/figures/methods.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::RunResult;

namespace {

// Mean and deviation of runs, each with the weight of its waves.
struct Spread {
  double n = 0, weight = 0, weight_squares = 0, sum = 0, squares = 0;
  void add(double v, double w) {
    if (!std::isfinite(v)) return;
    ++n;
    weight += w;
    weight_squares += w * w;
    sum += w * v;
    squares += w * v * v;
  }
  double mean() const { return n > 0 ? sum / weight : kAuto; }
  // Unknown of a single one.
  double deviation() const {
    return n > 1
               ? std::sqrt(std::max(0.0, (squares - sum * sum / weight) / (weight - weight_squares / weight)))
               : kAuto;
  }
};

// A trace that ran away from the truth has neither gain nor phase: least squares would tell its drift.
bool follows(const RunResult& run) { return run.heave_rmse_m < 0.25 * run.height_m; }

// On a sea the gain is that of the heave, as in the table of seas: mean heights of single waves are no gain.
double gain_of(const RunResult& run, bool sea) {
  const evaluation::HeightStatistics& s = run.statistics;
  if (!sea && s.waves > 0) return s.mean_height_m / s.mean_true_height_m;
  return follows(run) ? run.heave_gain : kAuto;
}

double phase_deg(const RunResult& run) {
  return follows(run) ? -360 * run.heave_lag_s / run.period_s : kAuto;
}

// Of one period and method, from the same runs. whole: none told nothing or hardly any waves.
struct Response {
  Spread gain, phase_deg;
  bool whole = true;
};

Response response_of(const std::vector<const RunResult*>& runs, bool seas) {
  const auto weight = [seas](const RunResult* run) {
    return seas ? 1 : static_cast<double>(std::max<std::int64_t>(1, run->statistics.waves));
  };
  const bool any_phase =
      std::ranges::any_of(runs, [](const RunResult* run) { return std::isfinite(phase_deg(*run)); });
  const double most = std::ranges::max(runs | std::views::transform(weight));
  Response response;
  for (const RunResult* run : runs) {
    const double gain = gain_of(*run, seas), phase = phase_deg(*run);
    const bool told = std::isfinite(gain) && (!any_phase || std::isfinite(phase));
    response.whole &= told && weight(run) >= most / 2;
    if (!told) continue;
    response.gain.add(gain, weight(run));
    response.phase_deg.add(phase, weight(run));
  }
  return response;
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
  const bool seas = are_seas(results);
  Axis period{.label = seas ? "Set peak period" : "Wave period", .unit = "s", .padding = 0.08};
  // A single period has no neighbours to be drawn to scale with.
  const bool single = grid.periods_s.size() == 1;
  if (single) period.categories = {fmt::format("{:g}", grid.periods_s.front())};
  Panel gain{.title = seas ? "(a) Gain: estimated over true heave"
                           : "(a) Gain: mean estimated over mean true wave height",
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
  bool any_part = false;
  const auto add = [&](Panel& panel, const std::map<double, Response>& by_period, Spread Response::*of,
                       const std::string& name, int color) {
    Line line{.name = name, .look = {.color = color, .marker = Marker::kCircle, .marker_pt = 4}};
    ErrorBars bars{.look = {.color = color, .width_pt = 0.8}};
    Points part{.look = {.color = color, .marker = Marker::kHollowCircle, .marker_pt = 4}};
    for (const auto& [period_s, response] : by_period) {
      const Spread& spread = response.*of;
      line.x.push_back(single ? 0 : period_s);
      line.y.push_back(spread.mean());  // unknown where no run tells it: the line breaks
      bars.minus.push_back(spread.deviation());
      bars.plus.push_back(spread.deviation());
      if (response.whole || spread.n == 0) continue;
      part.x.push_back(line.x.back());
      part.y.push_back(line.y.back());
    }
    bars.x = line.x;
    bars.y = line.y;
    const bool any = std::ranges::any_of(line.y, [](double y) { return std::isfinite(y); });
    if (!any) return false;
    any_part |= !part.x.empty();
    panel.marks.emplace_back(std::move(bars));
    panel.marks.emplace_back(std::move(line));
    if (!part.x.empty()) panel.marks.emplace_back(std::move(part));
    return true;
  };
  std::string without_phase;
  bool any = false;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::map<double, std::vector<const RunResult*>> runs;
    for (const RunResult& run : results.runs)
      if (run.method == methods[m]) runs[run.period_s].push_back(&run);
    std::map<double, Response> responses;
    for (const auto& [period_s, of_period] : runs) responses[period_s] = response_of(of_period, seas);
    any |= add(gain, responses, &Response::gain, methods[m], static_cast<int>(m));
    const bool has_phase = add(phase, responses, &Response::phase_deg, methods[m], static_cast<int>(m));
    any |= has_phase;
    if (!has_phase) without_phase += (without_phase.empty() ? "" : ", ") + methods[m];
  }
  if (!any) return figure;
  if (any_part)
    figure.subtitle += "; hollow: some runs of the period told nothing or less than half the waves of others";
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
