#include "rig/bench/report/control_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndCalibration;
using estimator::FrontEndChannel;

constexpr double kAt_degC = 20;
constexpr double kWidth = 0.5;   // of a calibration's place that its channels share

struct Place {
  double at = 0;
  Told told;
};

std::string kind_of(const std::string& channel) { return channel.substr(0, channel.find('_')); }   // gyro_1: gyro

render::Panel panel_of(Coefficient quantity, const std::string& kind, const std::vector<std::pair<std::string, std::vector<Place>>>& channels,
                       const std::vector<std::string>& dates) {
  const bool current = quantity == Coefficient::kBias;
  const double factor = current ? 1e9 : 1e6;
  render::Panel panel{.title = kind.empty() ? std::string(name_of(quantity)) : fmt::format("{}, {} channels", name_of(quantity), kind),
                      .x = {.categories = dates}, .y = {.label = "Since the first", .unit = current ? "nA" : "ppm"}, .legend = render::Legend::kAbove};
  double expanded = 0;   // of a difference, the largest of the channels
  for (const auto& [name, places] : channels)
    for (std::size_t i = 1; i < places.size(); ++i)
      expanded = std::max(expanded, factor * std::hypot(places[0].told.expanded, places[i].told.expanded));
  panel.marks.emplace_back(render::Span{.from = -1.5 * expanded, .to = 1.5 * expanded, .vertical = false, .name = "k = 3", .look = {.color = render::kFaintInk, .alpha = 0.08}});
  panel.marks.emplace_back(render::Span{.from = -expanded, .to = expanded, .vertical = false, .name = "k = 2"});
  panel.marks.emplace_back(render::Rule{.at = 0});
  int color = 0;
  for (const auto& [name, places] : channels) {
    const double aside = channels.size() < 2 ? 0 : kWidth * (static_cast<double>(color) / static_cast<double>(channels.size() - 1) - 0.5);
    render::ErrorBars bars{.look = {.color = color}};
    render::Line line{.look = {.color = color, .width_pt = 0.6, .alpha = 0.6}};
    render::Points points{.name = name, .look = {.color = color, .marker = render::Marker::kCircle, .marker_pt = 3}};
    for (const Place& p : places) {
      const double y = factor * (p.told.value - places.front().told.value), U = factor * p.told.expanded;
      for (auto* series : {&bars.x, &line.x, &points.x}) series->push_back(p.at + aside);
      for (auto* series : {&bars.y, &line.y, &points.y}) series->push_back(y);
      bars.minus.push_back(U);
      bars.plus.push_back(U);
    }
    panel.marks.emplace_back(std::move(line));
    panel.marks.emplace_back(std::move(bars));
    panel.marks.emplace_back(std::move(points));
    ++color;
  }
  return panel;
}

}  // namespace

render::Figure control_chart(const std::vector<FrontEndCalibration>& calibrations, bool reference_common) {
  render::Figure figure{.title = "Control chart at 20 °C",
                        .subtitle = calibrations.empty() ? "" : calibrations.front().unit + (reference_common ? ", reference's own error left out" : ""),
                        .columns = 2};
  std::vector<std::string> dates;
  for (const FrontEndCalibration& c : calibrations) dates.push_back(c.measured.substr(0, 10));
  for (const Coefficient quantity : {Coefficient::kScaleN, Coefficient::kScaleP, Coefficient::kBias, Coefficient::kOscillator}) {
    std::map<std::string, std::vector<std::pair<std::string, std::vector<Place>>>> kinds;
    const auto add = [&](std::size_t at, const FrontEndChannel& channel) {
      if (!measured(calibrations[at], channel, quantity)) return;
      auto& channels = kinds[kind_of(channel.name)];
      auto entry = std::ranges::find(channels, channel.name, &std::pair<std::string, std::vector<Place>>::first);
      if (entry == channels.end()) entry = channels.insert(channels.end(), {channel.name, {}});
      entry->second.push_back({static_cast<double>(at), told(calibrations[at], channel, quantity, kAt_degC, reference_common)});
    };
    for (std::size_t i = 0; i < calibrations.size(); ++i) {
      if (quantity == Coefficient::kOscillator) add(i, FrontEndChannel{});
      else for (const FrontEndChannel& channel : calibrations[i].channels) add(i, channel);
    }
    for (const auto& [kind, channels] : kinds) figure.panels.push_back(panel_of(quantity, kind, channels, dates));
  }
  figure.height_mm = 25 + 62 * std::ceil(static_cast<double>(figure.panels.size()) / 2);
  return figure;
}

}  // namespace waverig::rig::bench
