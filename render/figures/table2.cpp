#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/figures/accuracy.h"
#include "render/figures/settings.h"
#include "render/published.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

bool shows_published(const CampaignResults& results) {
  return std::ranges::any_of(settings_of(results), [](const Setting& s) {
    return published_cell(s.period_s, s.height_m) != nullptr;
  });
}

Figure table2_figure(const CampaignResults& results) {
  constexpr std::size_t kMostSettings = 30;  // more stand too close to be told apart: the maps show them
  std::vector<Setting> settings = settings_of(results);
  const bool all = settings.size() <= kMostSettings;
  if (!all)
    std::erase_if(settings,
                  [](const Setting& s) { return published_cell(s.period_s, s.height_m) == nullptr; });
  const std::vector<std::string> methods = methods_of(results);
  const bool published = shows_published(results);
  Figure figure{.title = published ? "Wave heights: published, and measured on this rig"
                                   : "Wave heights: set, and measured on this rig",
                .subtitle = published ? "campaign \"" + results.name +
                                            "\" beside Lee, Lee, Heo 2014, Table 2, which judges by the set "
                                            "height: what its rig made of that is not known"
                                      : "campaign \"" + results.name + "\"",
                .share_x = true,
                .height_mm = 130};
  if (!all) figure.subtitle += "; of its settings the published ones alone";
  Panel top{.title =
                "(a) Mean less true height, \u00B1 one standard deviation "
                "of single waves",
            .x = settings_axis(settings, false),
            .y = {.label = "Mean \u2212 true", .unit = "cm"},
            .legend = Legend::kAbove};
  Panel bottom{.title = "(b) Standard deviation of single waves",
               .x = settings_axis(settings, false),
               .y = {.label = "Standard deviation", .unit = "cm", .scale = Scale::kLog}};
  top.marks.emplace_back(Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});

  const double first = published ? 1 : 0;  // place of the first method, after the published one
  const double series = static_cast<double>(methods.size()) + first, step = 0.8 / series;
  const auto place = [&](std::size_t setting, double index) {
    return static_cast<double>(setting) - 0.4 + (index + 0.5) * step;
  };
  const auto add = [&](const std::string& name, int color, Marker marker, double index, auto error_m,
                       auto std_m) {
    const Look look{.color = color, .width_pt = 1.1, .marker = marker, .marker_pt = 5};
    Points points{.name = name, .look = look};
    ErrorBars errors{.look = {.color = color, .width_pt = 1.1, .marker_pt = 5}};
    Points spread{.look = look};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const double error_cm = cm(error_m(settings[i])), std_cm = cm(std_m(settings[i]));
      if (!std::isfinite(error_cm)) continue;
      points.x.push_back(place(i, index));
      points.y.push_back(error_cm);
      errors.x.push_back(place(i, index));
      errors.y.push_back(error_cm);
      errors.minus.push_back(std::isfinite(std_cm) ? std_cm : 0);
      errors.plus.push_back(std::isfinite(std_cm) ? std_cm : 0);
      spread.x.push_back(place(i, index));
      spread.y.push_back(std_cm);
    }
    if (points.x.empty()) return false;
    top.marks.emplace_back(std::move(errors));
    top.marks.emplace_back(std::move(points));
    bottom.marks.emplace_back(std::move(spread));
    return true;
  };
  add(
      "published", kFaintInk, Marker::kSquare, 0,
      [](const Setting& s) {
        const auto* c = published_cell(s.period_s, s.height_m);
        return c == nullptr ? kAuto : c->mean_height_m - s.height_m;
      },
      [](const Setting& s) {
        const auto* c = published_cell(s.period_s, s.height_m);
        return c == nullptr ? kAuto : c->std_m;
      });
  static constexpr std::array<Marker, 4> kMarkers = {Marker::kCircle, Marker::kDiamond, Marker::kTriangle,
                                                     Marker::kSquare};
  bool any_measured = false;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto of = [&results, &method = methods[m]](const Setting& s, auto member) {
      const CellResult* c = cell_of(results, s, method);
      return c == nullptr ? kAuto : c->statistics.*member;
    };
    any_measured |= add(
        methods[m], static_cast<int>(m), kMarkers[m % kMarkers.size()], static_cast<double>(m) + first,
        [&](const Setting& s) {
          return of(s, &evaluation::HeightStatistics::mean_height_m) -
                 of(s, &evaluation::HeightStatistics::mean_true_height_m);
        },
        [&](const Setting& s) { return of(s, &evaluation::HeightStatistics::std_m); });
  }
  if (!any_measured) return figure;
  // The bound lies below all of a setting's bars: one stroke across them.
  std::string bound_name = "bound (Cram\u00E9r\u2013Rao)";
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

}  // namespace waverig::render
