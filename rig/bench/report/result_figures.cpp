// What a run found, channel by channel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "rig/bench/report/figures.h"

namespace waverig::rig::bench {
namespace {

using estimator::TemperatureLaw;
using render::Band;
using render::ErrorBars;
using render::Figure;
using render::Legend;
using render::Line;
using render::Panel;
using render::Points;

constexpr double kPanel_mm = 46;
constexpr int kColumns = 2;

// A law as a line with its k = 2 band, from value(T) = factor * (law(T) - less).
void add_law(Panel& panel, const TemperatureLaw& law, double factor, double less,
             const std::function<double(double)>& expanded, const std::string& name, int color) {
  Line line{.name = name, .look = {.color = color}};
  Band band{.look = {.color = color, .alpha = 0.18}};
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    const double T = std::lerp(law.from_degC, law.to_degC, static_cast<double>(i) / kSteps);
    const double y = factor * (law.at(T) - less), U = factor * expanded(T);
    line.x.push_back(T);
    line.y.push_back(y);
    band.x.push_back(T);
    band.low.push_back(y - U);
    band.high.push_back(y + U);
  }
  panel.marks.emplace_back(std::move(band));
  panel.marks.emplace_back(std::move(line));
}

Figure channel_figure(const std::string& title, const std::string& subtitle, std::size_t channels) {
  const auto rows = static_cast<double>((channels + kColumns - 1) / kColumns);
  return {.title = title, .subtitle = subtitle, .columns = kColumns, .height_mm = 25 + kPanel_mm * rows};
}

Panel scale_panel(const ChannelAnalysis& measured, const estimator::FrontEndChannel& channel) {
  Panel panel{.title = measured.channel,
              .x = {.label = "Temperature", .unit = "°C"},
              .y = {.label = "ΔSF", .unit = "ppm"}};
  for (const bool negative : {true, false}) {
    const TemperatureLaw& law = negative ? channel.dsf_N : channel.dsf_P;
    const double K0_C = negative ? channel.K_N0_C : channel.K_P0_C;
    const int color = negative ? 0 : 1;
    add_law(
        panel, law, 1e6, 0, [&](double T) { return 2 * law.sigma_at(T); }, negative ? "N" : "P", color);
    Points points{.look = {.color = color,
                           .marker = negative ? render::Marker::kCircle : render::Marker::kSquare,
                           .marker_pt = 3.5}};
    for (const estimator::ScaleFactorsAtTemperature& p : measured.scale_factors) {
      points.x.push_back(p.temperature_degC);
      points.y.push_back(1e6 * ((negative ? p.factors.K_N_C : p.factors.K_P_C) / K0_C - 1));
    }
    panel.marks.emplace_back(std::move(points));
  }
  return panel;
}

Panel bias_panel(const ChannelAnalysis& measured, const estimator::FrontEndChannel& channel) {
  Panel panel{.title = measured.channel,
              .x = {.label = "Temperature", .unit = "°C"},
              .y = {.label = "Bias", .unit = "nA"}};
  add_law(
      panel, channel.bias_A, 1e9, 0, [&](double T) { return channel.bias_expanded_A(T); }, "law, k = 2",
      render::kInk);
  Points up{.name = "up", .look = {.color = 0, .marker = render::Marker::kTriangle, .marker_pt = 2.6}};
  Points down{.name = "down", .look = {.color = 1, .marker = render::Marker::kCircle, .marker_pt = 2.2}};
  for (const estimator::BiasPoint& p : measured.bias->loop) {
    up.x.push_back(p.temperature_degC);
    up.y.push_back(1e9 * p.up_A);
    down.x.push_back(p.temperature_degC);
    down.y.push_back(1e9 * p.down_A);
  }
  panel.marks.emplace_back(std::move(up));
  panel.marks.emplace_back(std::move(down));
  return panel;
}

}  // namespace

Figure scale_factor_figure(const Analysis& analysis) {
  Figure figure = channel_figure(
      "Scale factors against temperature",
      "Departure from the design, of the negative (N) and the positive (P) reset current; band: k = 2",
      analysis.channels.size());
  for (const ChannelAnalysis& measured : analysis.channels)
    if (!measured.scale_factors.empty())
      figure.panels.push_back(scale_panel(measured, analysis.calibration.channel(measured.channel)));
  return figure;
}

Figure closure_figure(const Analysis& analysis) {
  Figure figure{.title = "Closure: what the fits leave over",
                .subtitle = "Fitted less commanded or metered current, of each level, at all temperatures",
                .height_mm = 85};
  // One panel for each kind of channel, which differ in their levels.
  for (const char* kind : {"gyro", "accel"}) {
    Panel panel{.title = fmt::format("{} channels", kind),
                .x = {.label = "Level", .unit = "mA", .scale = render::Scale::kLog},
                .y = {.label = "Residual", .unit = "ppm"},
                .legend = Legend::kAbove};
    for (const int polarity : {1, -1, 0}) {
      Points points{.name = polarity > 0   ? "positive"
                            : polarity < 0 ? "negative"
                                           : "both in one row",
                    .look = {.color = polarity < 0 ? 1 : 0,
                             .marker = polarity < 0 ? render::Marker::kHollowCircle : render::Marker::kCircle,
                             .marker_pt = 3,
                             .alpha = 0.7}};
      for (const ChannelAnalysis& measured : analysis.channels) {
        if (!measured.channel.starts_with(kind)) continue;
        for (const auto& p : measured.scale_factors)
          for (const estimator::RowResidual& r : p.factors.residuals) {
            if (r.polarity != polarity) continue;
            points.x.push_back(1e3 * r.level_A * (1 + 0.03 * polarity));  // side by side
            points.y.push_back(1e6 * r.relative);
          }
      }
      if (!points.x.empty()) panel.marks.emplace_back(std::move(points));
    }
    if (panel.marks.empty()) continue;  // a unit without such channels
    panel.marks.emplace_back(render::Rule{.at = 0});
    figure.panels.push_back(std::move(panel));
  }
  figure.columns = std::clamp(static_cast<int>(figure.panels.size()), 1, kColumns);
  return figure;
}

Figure bias_figure(const Analysis& analysis) {
  Figure figure = channel_figure("Bias against temperature",
                                 "Ramp up and ramp down in bins of 1 °C; band: k = 2, hysteresis included",
                                 analysis.channels.size());
  for (const ChannelAnalysis& measured : analysis.channels)
    if (measured.bias)
      figure.panels.push_back(bias_panel(measured, analysis.calibration.channel(measured.channel)));
  return figure;
}

Figure oscillator_figure(const Analysis& analysis) {
  Figure figure{.title = "Master oscillator",
                .subtitle = "Against the function generator; band: k = 2, the generator's own 3 ppm included",
                .height_mm = 80};
  Panel panel{.x = {.label = "Temperature", .unit = "°C"}, .y = {.label = "Error", .unit = "ppm"}};
  const TemperatureLaw& law = analysis.oscillator.law;
  Points points{.name = "100 s counts",
                .look = {.color = 1, .marker = render::Marker::kCircle, .marker_pt = 4}};
  for (const estimator::TemperaturePoint& p : analysis.oscillator.points) {
    points.x.push_back(p.temperature_degC);
    points.y.push_back(1e6 * p.value);
  }
  panel.marks.emplace_back(std::move(points));
  add_law(
      panel, law, 1e6, 0, [&](double T) { return 2 * law.sigma_at(T); }, "law, k = 2", 0);
  figure.panels.push_back(std::move(panel));
  return figure;
}

std::vector<BenchFigure> bench_figures(const Sequence& sequence, const Store& store,
                                       const Analysis* analysis) {
  const Traces traces = traces_of(sequence, store);
  std::vector<BenchFigure> figures;
  figures.push_back(
      {"temperature",
       "Temperature profile: what the chamber was told, where the unit was, and when it was recorded.",
       temperature_figure(sequence, store, traces)});
  figures.push_back({"procedure", "Procedure: when each channel and setting was measured.",
                     procedure_figure(sequence, store)});
  if (!sequence.windows.empty())
    figures.push_back({"windows", "The live view's windows over the whole run.",
                       windows_figure(sequence.windows, traces, sequence.title, "")});
  if (analysis != nullptr && sequence.procedure.starts_with("scale_factor")) {
    figures.push_back({"scale_factors",
                       "Scale factors of each channel against temperature, with the law chosen by the data.",
                       scale_factor_figure(*analysis)});
    figures.push_back(
        {"closure", "Closure: each level's residual about its channel's fit.", closure_figure(*analysis)});
  }
  if (analysis != nullptr && sequence.procedure == "bias") {
    figures.push_back(
        {"bias", "Bias of each channel against temperature, up and down.", bias_figure(*analysis)});
    figures.push_back({"oscillator", "The master oscillator's error.", oscillator_figure(*analysis)});
  }
  return figures;
}

}  // namespace waverig::rig::bench
