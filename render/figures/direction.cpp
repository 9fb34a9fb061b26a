#include "render/figures/direction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "render/figures/methods.h"
#include "render/figures/settings.h"
#include "render/ticks.h"

namespace waverig::render {

Panel rose_panel(std::string title, const std::vector<double>& directions_rad,
                 const std::vector<double>& hm0_m) {
  constexpr std::size_t kSectors = 16, kClasses = 4;
  constexpr double kSector = 2 * std::numbers::pi / kSectors;
  Panel panel{.title = std::move(title), .y = {.unit = "%", .low = 0}, .polar = true, .compass = true};
  double highest = 0;
  std::vector<std::array<std::size_t, 2>> hits;  // sector, sample
  for (std::size_t i = 0; i < std::min(directions_rad.size(), hm0_m.size()); ++i) {
    if (!std::isfinite(directions_rad[i]) || !std::isfinite(hm0_m[i])) continue;
    const double turns = directions_rad[i] / kSector;
    hits.push_back(
        {static_cast<std::size_t>(std::lround(turns - kSectors * std::floor(turns / kSectors))) % kSectors,
         i});
    highest = std::max(highest, hm0_m[i]);
  }
  const double step = highest > 0 ? nice_step(highest, kClasses) : 1;
  std::array<double, kSectors> base{};
  for (std::size_t c = 0; c < kClasses; ++c) {
    const double from = static_cast<double>(c) * step, to = from + step;
    if (c > 0 && from >= highest) break;
    const bool last =
        to >= highest || c + 1 == kClasses;  // the highest sea is its own class's upper edge, too
    Bars bars{.name = fmt::format("Hm0 {:g} to {:g} m", from, to),
              .look = {.ramp = static_cast<double>(c) / (kClasses - 1)},
              .width = 0.9 * kSector};
    std::array<double, kSectors> share{};
    bool any = false;
    for (const auto& [sector, i] : hits) {
      if (hm0_m[i] >= from && (hm0_m[i] < to || last)) {
        share[sector] += 100.0 / static_cast<double>(hits.size());
        any = true;
      }
    }
    if (!any && highest > 0) continue;  // no such sea: nothing to explain
    for (std::size_t s = 0; s < kSectors; ++s) {
      bars.at.push_back(static_cast<double>(s) * kSector);
      bars.base.push_back(base[s]);
      base[s] += share[s];
      bars.value.push_back(base[s]);
    }
    panel.marks.emplace_back(std::move(bars));
  }
  return panel;
}

std::optional<Figure> direction_figure(const evaluation::CampaignResults& results) {
  struct Seas {
    std::vector<double> directions_rad, hm0_m, period_s, error_deg, spread_deg, true_spread_deg;
  };
  std::map<std::string, Seas> by_method;
  for (const evaluation::RunResult& run : results.runs) {
    for (const evaluation::JudgedSea& judged : run.seas) {
      const estimator::SeaState& sea = judged.sea;
      if (!std::isfinite(sea.mean_direction_rad)) continue;
      Seas& seas = by_method[run.method];
      seas.directions_rad.push_back(sea.mean_direction_rad);
      seas.hm0_m.push_back(sea.hm0_m);
      seas.period_s.push_back(run.period_s);
      seas.error_deg.push_back(judged.direction_error_rad() / kDegree);
      seas.spread_deg.push_back(sea.spread_rad / kDegree);
      seas.true_spread_deg.push_back(judged.direction.spread_rad / kDegree);
    }
  }
  if (by_method.empty()) return std::nullopt;
  Figure figure{
      .title = "Directions the waves came from",
      .subtitle = "share of sea states by mean direction, true north up; each run against its truth",
      .height_mm = 110};
  figure.columns = static_cast<int>(std::min<std::size_t>(by_method.size(), 3));
  for (const auto& [method, seas] : by_method)
    figure.panels.push_back(rose_panel(method, seas.directions_rad, seas.hm0_m));

  const bool judged = std::ranges::any_of(by_method, [](const auto& of) {
    return std::ranges::any_of(of.second.error_deg, [](double e) { return std::isfinite(e); });
  });
  if (!judged) return figure;
  const Axis period{.label = "Set period", .unit = "s"};
  Panel error{.title = "Direction error", .x = period, .y = {.label = "Told \u2212 true", .unit = "°"}};
  Panel spread{.title = "Spread", .x = period, .y = {.label = "Spread", .unit = "°", .low = 0}};
  const std::vector<std::string> methods = all_methods_of(results);
  std::string truth_name = "truth";
  for (const auto& [method, seas] : by_method) {
    const int color = method_color(methods, method);
    error.marks.emplace_back(Points{.x = seas.period_s,
                                    .y = seas.error_deg,
                                    .name = method,
                                    .look = {.color = color, .marker = Marker::kCircle}});
    spread.marks.emplace_back(Points{.x = seas.period_s,
                                     .y = seas.spread_deg,
                                     .name = method,
                                     .look = {.color = color, .marker = Marker::kCircle}});
    spread.marks.emplace_back(Points{.x = seas.period_s,
                                     .y = seas.true_spread_deg,
                                     .name = std::exchange(truth_name, ""),
                                     .look = {.color = kInk, .marker = Marker::kHollowCircle}});
  }
  error.marks.emplace_back(Rule{.at = 2, .name = "\u00B1 2\u00B0 (CDIP)"});
  error.marks.emplace_back(Rule{.at = -2});
  error.legend = spread.legend = Legend::kAbove;
  figure.subtitle += "\nCDIP: what the Coastal Data Information Program asks of a buoy on its test wheel";
  figure.panels.push_back(std::move(error));
  figure.panels.push_back(std::move(spread));
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    figure.panels[i].title = fmt::format("({}) {}", static_cast<char>('a' + i), figure.panels[i].title);
  figure.columns = static_cast<int>(std::min<std::size_t>(figure.panels.size(), 3));
  return figure;
}

}  // namespace waverig::render
