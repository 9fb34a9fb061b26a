#include "render/figures/calibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lcmtypes/error.h"

namespace waverig::render {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

// In the order of error_over_sigma: M row by row, the bias, then what else was
// solved for.
std::vector<std::string> unknown_names(std::size_t n) {
  std::vector<std::string> names;
  for (const char* row : kAxes) {
    for (const char* column : kAxes) names.push_back(fmt::format("M {}{}", row, column));
  }
  for (const char* axis : kAxes) names.push_back(fmt::format("b {}", axis));
  for (const char* axis : kAxes) names.push_back(fmt::format("q {}", axis));
  while (names.size() < n) names.push_back(std::to_string(names.size() + 1));
  names.resize(n);
  return names;
}

Panel residual_panel(const json& positions) {
  Panel panel{.title = "(a) What the fit leaves over, position by position",
              .x = {.label = "Axis that points up or down"},
              .y = {.label = "Residual", .unit = "mm/s\u00B2"},
              .legend = Legend::kAbove};
  std::array<Bars, 3> bars;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bars[axis].name = fmt::format("f {}", kAxes[axis]);
    bars[axis].width = 0.25;
    bars[axis].look.color = axis_color(axis);
  }
  for (const json& position : positions) {
    const auto at = static_cast<double>(panel.x.categories.size());
    panel.x.categories.push_back(position.at("name").get<std::string>());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bars[axis].at.push_back(at + 0.27 * (static_cast<double>(axis) - 1));
      bars[axis].value.push_back(1000 * position.at("residual_mps2").at(axis).get<double>());
    }
  }
  for (Bars& b : bars) panel.marks.emplace_back(std::move(b));
  return panel;
}

Panel truth_panel(const json& truth) {
  Panel panel{.title = "(b) Result less simulated truth, in its own standard uncertainties",
              .x = {.label = "Parameter: matrix M, bias b, bend q"},
              .y = {.label = "Error / \u03C3"},
              .legend = Legend::kAbove};
  Points points{.name = "found \u2212 true",
                .look = {.color = 0, .marker = Marker::kCircle, .marker_pt = 4.5}};
  const auto errors = truth.at("error_over_sigma").get<std::vector<double>>();
  panel.x.categories = unknown_names(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    points.x.push_back(static_cast<double>(i));
    points.y.push_back(errors[i]);
  }
  panel.marks.emplace_back(Span{.from = -2, .to = 2, .vertical = false, .name = "\u00B1 2\u03C3"});
  panel.marks.emplace_back(
      Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});
  panel.marks.emplace_back(std::move(points));
  panel.y.padding = 0.15;
  // The band belongs to the picture even where every error is small.
  panel.marks.emplace_back(Line{.x = {0, 0}, .y = {-2, 2}, .look = {.color = kFaintInk, .alpha = 0}});
  return panel;
}

}  // namespace

std::optional<Figure> calibration_figure(const std::string& text) {
  if (text.empty()) return std::nullopt;
  try {
    const json report = json::parse(text);
    Figure figure{.title = "Accelerometer calibration in six positions", .height_mm = 120};
    if (report.contains("positions")) figure.panels.push_back(residual_panel(report.at("positions")));
    if (report.contains("simulated_truth")) {
      const json& truth = report.at("simulated_truth");
      figure.panels.push_back(truth_panel(truth));
      figure.subtitle =
          fmt::format("\u03C7\u00B2 = {:.1f} of result against truth for {} parameters",
                      truth.at("chi_square").get<double>(), truth.at("degrees_of_freedom").get<int>());
    }
    if (figure.panels.empty()) return std::nullopt;
    if (figure.panels.size() == 1) figure.height_mm = 75;
    return figure;
  } catch (const json::exception& error) {
    throw UserError(
        fmt::format("calibration report: {}: a sensor calibration in JSON expected", error.what()));
  }
}

}  // namespace waverig::render
