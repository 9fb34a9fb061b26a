#include "rig/cli/compass_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace waverig::cli {
namespace {

using estimator::Angle;
using estimator::Curve;
using estimator::ErrorFigure;
using estimator::Order;
using estimator::Quantity;
using estimator::TiltStudy;
using render::Band;
using render::Figure;
using render::Line;
using render::Note;
using render::Panel;
using render::Rule;
using render::Span;

constexpr double kLargestBorder_of_g = 0.5;  // border_of_g() looks no further

std::vector<double> in_degrees(std::vector<double> values) {
  for (double& v : values) v /= kDegree;
  return values;
}

render::Axis tilt_axis() { return {.label = "Roll = pitch", .unit = "°", .padding = 0}; }

// A curve over the runs with its 95 % band, and the document's largest value as a line across.
Panel curve_panel(const std::string& title, const std::vector<double>& tilt_deg,
                  const std::vector<double>& value_rad, const std::vector<double>& sigma_rad,
                  double published_deg, bool both_signs) {
  constexpr double kNormal95 = 1.959964;
  std::vector<double> low, high;
  for (std::size_t i = 0; i < value_rad.size(); ++i) {
    low.push_back((value_rad[i] - kNormal95 * sigma_rad[i]) / kDegree);
    high.push_back((value_rad[i] + kNormal95 * sigma_rad[i]) / kDegree);
  }
  Panel panel{.title = title, .x = tilt_axis(), .y = {.label = title, .unit = "°", .include_zero = true}};
  panel.marks = {
      Band{.x = tilt_deg, .low = low, .high = high, .name = "95 %", .look = {.color = 0, .alpha = 0.25}},
      Line{.x = tilt_deg, .y = in_degrees(value_rad), .name = "simulated", .look = {.color = 0}}};
  if (std::isfinite(published_deg))
    panel.marks.push_back(Rule{.at = published_deg, .name = "published, largest"});
  if (both_signs) panel.marks.push_back(Rule{.at = -published_deg});
  return panel;
}

double published(const TiltStudy& study, const std::string& name) {
  for (const auto& figure : study.figures)
    if (figure.name == name) return figure.published;
  return render::kAuto;
}

// Standard deviation that the linear formulas predict along the sweep.
std::vector<double> linear_std_deg(const TiltStudy& study, Angle angle, double heading_rad) {
  std::vector<double> result;
  for (const double t : study.tilt_rad) {
    const Vector3d triad = study.settings.gravity_mps2 *
                           Vector3d(std::sin(t), std::sin(t) * std::cos(t), std::cos(t) * std::cos(t));
    const estimator::Expansions e =
        estimator::expand(triad, estimator::field_B(heading_rad, study.settings.dip_rad, {t, t}));
    const estimator::Expansion& of = angle == Angle::kRoll    ? e.roll
                                     : angle == Angle::kPitch ? e.pitch
                                                              : e.heading;
    result.push_back(first_order(of, study.settings.accel_error_sigma_mps2).std_rad / kDegree);
  }
  return result;
}

struct AngleFigure {
  int number;
  const char *file, *title, *formula, *prefix;
  Quantity error, miss;
  Angle angle;
  int heading;  // index of the case
  double published_std_deg;
};

Figure angle_figure(const TiltStudy& study, const AngleFigure& of) {
  const std::vector<double> tilt_deg = in_degrees(study.tilt_rad);
  const auto q = [](Quantity quantity) { return static_cast<std::size_t>(quantity); };
  const Curve &error = study.curves[q(of.error)], &miss = study.curves[q(of.miss)];
  const std::string name = of.prefix;
  Figure figure{.title = fmt::format("Figure {}: {}", of.number, of.title),
                .subtitle = fmt::format("{} runs, accelerometer error N(0, ({} m/s²)²) per axis, dip {:.0f}°",
                                        study.settings.runs, study.settings.accel_error_sigma_mps2,
                                        study.settings.dip_rad / kDegree),
                .columns = 2,
                .height_mm = 130};

  Panel one{.title = "One run", .x = tilt_axis(), .y = {.label = "Error", .unit = "°"}};
  one.marks = {Line{.x = tilt_deg, .y = in_degrees(study.example.error[q(of.error)]), .name = "error"},
               Line{.x = tilt_deg,
                    .y = in_degrees(study.example.predicted[q(of.error)]),
                    .name = fmt::format("by {}", of.formula),
                    .look = {.dash = render::Dash::kDashed}}};
  Panel spread =
      curve_panel("Standard deviation", tilt_deg, error.std, error.std_sigma, of.published_std_deg, false);
  spread.marks.push_back(Line{
      .x = tilt_deg,
      .y = linear_std_deg(study, of.angle, study.settings.heading_rad[static_cast<std::size_t>(of.heading)]),
      .name = "linear formulas",
      .look = {.color = 1, .dash = render::Dash::kDashed}});
  figure.panels = {
      one, spread,
      curve_panel(fmt::format("Miss of {}: mean", of.formula), tilt_deg, miss.mean, miss.mean_sigma,
                  published(study, name + ", linear formula's miss, largest mean"), true),
      curve_panel(fmt::format("Miss of {}: standard deviation", of.formula), tilt_deg, miss.std,
                  miss.std_sigma, published(study, name + ", linear formula's miss, largest std"), false)};
  figure.panels[2].y.label = "Mean";
  figure.panels[2].legend = render::Legend::kNone;
  figure.panels[3].y.label = "Standard deviation";
  return figure;
}

// Points of the sweep between which the two-axis module flags the sign of z, for the run that is drawn. An
// empty range where it never does.
std::pair<std::size_t, std::size_t> doubtful_sign(const TiltStudy& study) {
  const estimator::TiltStudySettings& s = study.settings;
  const estimator::TwoAxisSettings module{.tilt_sigma_rad = s.accel_error_sigma_mps2 / s.gravity_mps2,
                                          .field_sigma = s.field_noise};
  std::pair<std::size_t, std::size_t> range{study.tilt_rad.size(), 0};
  for (std::size_t i = 0; i < study.tilt_rad.size(); ++i) {
    const double tilt_rad = study.tilt_rad[i];
    const Vector3d m_B = estimator::field_B(s.heading_rad[0], s.dip_rad, {tilt_rad, tilt_rad});
    const estimator::Tilt found{study.example.computed[0][i], study.example.computed[1][i]};
    if (!estimator::reconstruct_z(m_B.x(), m_B.y(), found, s.dip_rad, module).sign_doubtful) continue;
    range = {std::min(range.first, i), std::max(range.second, i)};
  }
  return range;
}

Figure two_axis_figure(const TiltStudy& study) {
  const auto& example = study.example;
  const std::vector<double> tilt_deg = in_degrees(study.tilt_rad);
  Figure figure{
      .title = "Figure 6: dip and z from two axes", .subtitle = "One run", .columns = 1, .height_mm = 130};
  Panel dip{.title = "Dip from a level turn, eq. (25)",
            .x = {.label = "Heading", .unit = "°", .padding = 0},
            .y = {.label = "Dip", .unit = "°"}};
  dip.marks = {Line{.x = in_degrees(example.turn_heading),
                    .y = in_degrees(example.turn_dip),
                    .name = "estimated",
                    .look = {.width_pt = 0.6}},
               Rule{.at = study.settings.dip_rad / kDegree, .name = "true"}};
  Panel z{.title = "z along the sweep, eq. (24), case I",
          .x = tilt_axis(),
          .y = {.label = "z of the unit field"}};
  z.marks = {
      Line{.x = tilt_deg, .y = example.z_estimated, .name = "estimated"},
      Line{.x = tilt_deg, .y = example.z_true, .name = "true", .look = {.dash = render::Dash::kDashed}},
      Note{.x = 0.4,
           .y = 0.38,
           .text = "Where the tilt error turns the sign of eq. (23),\nz jumps to its mirror image"}};
  if (const auto [first, last] = doubtful_sign(study); first <= last)
    z.marks.insert(z.marks.begin(),
                   Span{.from = tilt_deg[first], .to = tilt_deg[last], .name = "flagged: sign in doubt"});
  figure.panels = {dip, z};
  return figure;
}

Figure border_figure(const TiltStudy& study, const std::vector<BorderPoint>& border) {
  constexpr const char* kNames[] = {"Roll", "Pitch", "Heading"};
  Figure figure{
      .title = "Where the error formulas stop being good enough",
      .subtitle = fmt::format("Below a line the single error is told to a tenth of its size; dashed: the "
                              "document's 1 m/s²; heading {:.0f}°, dip {:.0f}°",
                              study.settings.heading_rad[0] / kDegree, study.settings.dip_rad / kDegree),
      .columns = 3,
      .height_mm = 90};
  for (std::size_t a = 0; a < 3; ++a) {
    Panel panel{.title = kNames[a],
                .x = {.label = "Roll = pitch", .unit = "°", .padding = 0},
                .y = {.scale = render::Scale::kLog, .low = 5e-3, .high = 1},
                .legend = render::Legend::kNone};
    if (a == 0) panel.y.label = "Accelerometer error (1 σ), of g";
    std::vector<double> tilt_deg, first, second, floor, top;
    for (const BorderPoint& point : border) {
      tilt_deg.push_back(point.tilt_rad / kDegree);
      first.push_back(point.first_of_g[a]);
      second.push_back(point.second_of_g[a]);
      floor.push_back(5e-3);
      top.push_back(1);
    }
    panel.marks = {
        Band{.x = tilt_deg, .low = floor, .high = first, .look = {.color = 2, .alpha = 0.25}},
        Band{.x = tilt_deg, .low = first, .high = second, .look = {.color = 1, .alpha = 0.25}},
        Band{.x = tilt_deg, .low = second, .high = top, .look = {.color = render::kFaintInk, .alpha = 0.15}},
        Line{.x = tilt_deg, .y = first, .look = {.color = 2}},
        Line{.x = tilt_deg, .y = second, .look = {.color = 1}},
        Rule{.at = study.settings.accel_error_sigma_mps2 / study.settings.gravity_mps2,
             .look = {.color = render::kInk, .width_pt = 0.8, .dash = render::Dash::kDashed}}};
    // Named where they are: a legend of one panel would lift its title above those beside it.
    const std::size_t middle = tilt_deg.size() / 4;
    const auto name = [&](const char* text, double low, double high) {
      panel.marks.emplace_back(
          Note{.x = tilt_deg[middle], .y = std::sqrt(low * high), .text = text, .in_data = true});
    };
    name("linear", floor[middle], first[middle]);
    name("second order", first[middle], second[middle]);
    name("exact figure", second[middle], top[middle]);
    figure.panels.push_back(panel);
  }
  return figure;
}

}  // namespace

std::vector<BorderPoint> border_of(const estimator::TiltStudySettings& settings) {
  constexpr int kPoints = 15;
  constexpr double kStep = 5 * kDegree;
  std::vector<BorderPoint> border(kPoints);
  const auto fill = [&](std::size_t i) {
    BorderPoint& point = border[i];
    point.tilt_rad = static_cast<double>(i) * kStep;
    const estimator::Tilt tilt{point.tilt_rad, point.tilt_rad};
    for (int a = 0; a < 3; ++a) {
      const auto angle = static_cast<Angle>(a);
      const double heading = settings.heading_rad[0];
      point.first_of_g[a] = estimator::border_of_g(tilt, heading, settings.dip_rad, angle, Order::kFirst);
      point.second_of_g[a] =
          std::max(point.first_of_g[a],
                   estimator::border_of_g(tilt, heading, settings.dip_rad, angle, Order::kSecond));
    }
  };
  const auto threads = static_cast<std::size_t>(
      settings.threads > 0 ? settings.threads
                           : static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  std::vector<std::jthread> pool;
  for (std::size_t t = 0; t < threads; ++t)
    pool.emplace_back([&, t] {
      for (std::size_t i = t; i < kPoints; i += threads) fill(i);
    });
  pool.clear();
  return border;
}

std::vector<NamedFigure> compass_figures(const TiltStudy& study, const std::vector<BorderPoint>& border) {
  constexpr AngleFigure kFigures[] = {
      {2, "figure2_roll", "roll error by the accelerometer", "eq. (28)", "roll", Quantity::kRoll,
       Quantity::kRollMiss, Angle::kRoll, 0, 9.3696},
      {3, "figure3_pitch", "pitch error by the accelerometer", "eq. (32)", "pitch", Quantity::kPitch,
       Quantity::kPitchMiss, Angle::kPitch, 0, 6.1836},
      {4, "figure4_heading1", "heading error, case I (45°)", "eq. (38)", "heading I", Quantity::kHeading1,
       Quantity::kHeading1Miss, Angle::kHeading, 0, render::kAuto},
      {5, "figure5_heading2", "heading error, case II (−135°)", "eq. (38)", "heading II", Quantity::kHeading2,
       Quantity::kHeading2Miss, Angle::kHeading, 1, render::kAuto}};
  std::vector<NamedFigure> figures;
  for (const AngleFigure& of : kFigures) figures.push_back({of.file, angle_figure(study, of)});
  figures.push_back({"figure6_two_axes", two_axis_figure(study)});
  figures.push_back({"border", border_figure(study, border)});
  return figures;
}

}  // namespace waverig::cli
