#include "rig/bench/report/control_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndCalibration;
using estimator::FrontEndChannel;

constexpr double kAt_degC = 20;
constexpr double kWidth = 0.5;  // of a calibration's place that its channels share

struct Place {
  std::size_t calibration = 0;
  Told told;
};

struct Series {
  std::string channel;
  std::vector<Place> places;
  // A merged calibration repeats what its parts measured: no measurement of its own.
  void add(const Place& place) {
    const bool known = std::ranges::any_of(places, [&](const Place& p) {
      return p.told.value == place.told.value && p.told.expanded == place.told.expanded;
    });
    if (!known) places.push_back(place);
  }
};

std::string kind_of(const std::string& channel) {
  return channel.substr(0, channel.find('_'));
}  // gyro_1: gyro

render::Panel panel_of(Coefficient quantity, const std::string& kind, const std::vector<Series>& channels,
                       const std::vector<FrontEndCalibration>& calibrations) {
  const bool current = quantity == Coefficient::kBias;
  const double factor = current ? 1e9 : 1e6;
  render::Panel panel{.title = kind.empty() ? std::string(name_of(quantity))
                                            : fmt::format("{}, {} channels", name_of(quantity), kind),
                      .y = {.label = "Change since the first", .unit = current ? "nA" : "ppm"},
                      .legend = render::Legend::kAbove};
  std::set<std::size_t> shown;
  double expanded = 0, most = 0;  // of a difference, the largest of the channels; of all that is drawn
  for (const Series& series : channels) {
    for (const Place& p : series.places) {
      shown.insert(p.calibration);
      const Told& first = series.places.front().told;
      if (&p.told != &first)
        expanded = std::max(expanded, factor * std::hypot(first.expanded, p.told.expanded));
      most = std::max(most, factor * (std::abs(p.told.value - first.value) + p.told.expanded));
    }
  }
  for (const std::size_t at : shown)
    panel.x.categories.push_back(calibrations[at].measured.substr(0, 10) + "\n" + calibrations[at].procedure);
  if (expanded > 0) {
    const render::Look action{.color = render::kFaintInk, .alpha = 0.1};
    panel.marks.emplace_back(render::Span{.from = -expanded,
                                          .to = expanded,
                                          .vertical = false,
                                          .name = "k = 2",
                                          .look = {.color = render::kFaintInk, .alpha = 0.3}});
    panel.marks.emplace_back(render::Span{
        .from = expanded, .to = 1.5 * expanded, .vertical = false, .name = "k = 3", .look = action});
    panel.marks.emplace_back(
        render::Span{.from = -1.5 * expanded, .to = -expanded, .vertical = false, .look = action});
  }
  panel.y.high = 1.08 * std::max(most, 1.5 * expanded);  // both limits are seen
  panel.y.low = -panel.y.high;
  panel.marks.emplace_back(render::Rule{.at = 0});
  int color = 0;
  for (const Series& series : channels) {
    const double aside =
        channels.size() < 2
            ? 0
            : kWidth * (static_cast<double>(color) / static_cast<double>(channels.size() - 1) - 0.5);
    render::ErrorBars bars{.look = {.color = color}};
    render::Line line{.look = {.color = color, .width_pt = 0.6, .alpha = 0.6}};
    render::Points points{.name = series.channel,
                          .look = {.color = color, .marker = render::Marker::kCircle, .marker_pt = 3}};
    for (const Place& p : series.places) {
      const double x = static_cast<double>(std::distance(shown.begin(), shown.find(p.calibration))) + aside;
      const double y = factor * (p.told.value - series.places.front().told.value),
                   U = factor * p.told.expanded;
      for (auto* values : {&bars.x, &line.x, &points.x}) values->push_back(x);
      for (auto* values : {&bars.y, &line.y, &points.y}) values->push_back(y);
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
  render::Figure figure{
      .subtitle = calibrations.empty()
                      ? ""
                      : calibrations.front().unit +
                            "; in the order of measurement; bands: uncertainty of a difference" +
                            (reference_common ? ", reference's own error left out" : ""),
      .columns = 2};
  std::string quantities;
  for (const Coefficient quantity :
       {Coefficient::kScaleN, Coefficient::kScaleP, Coefficient::kBias, Coefficient::kOscillator}) {
    std::map<std::string, std::vector<Series>> kinds;
    const auto add = [&](std::size_t at, const FrontEndChannel& channel) {
      if (!measured(calibrations[at], channel, quantity)) return;
      auto& channels = kinds[kind_of(channel.name)];
      auto series = std::ranges::find(channels, channel.name, &Series::channel);
      if (series == channels.end()) series = channels.insert(channels.end(), {channel.name, {}});
      series->add({at, told(calibrations[at], channel, quantity, kAt_degC, reference_common)});
    };
    for (std::size_t i = 0; i < calibrations.size(); ++i) {
      if (quantity == Coefficient::kOscillator)
        add(i, FrontEndChannel{});
      else
        for (const FrontEndChannel& channel : calibrations[i].channels) add(i, channel);
    }
    for (const auto& [kind, channels] : kinds)
      figure.panels.push_back(panel_of(quantity, kind, channels, calibrations));
    if (!kinds.empty()) quantities += (quantities.empty() ? "" : ", ") + std::string(name_of(quantity));
  }
  figure.title = fmt::format("Control chart at {:g} °C: {}", kAt_degC, quantities);
  figure.height_mm = 25 + 68 * std::ceil(static_cast<double>(figure.panels.size()) / 2);
  return figure;
}

}  // namespace waverig::rig::bench
