#include "render/figures/paper.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/figures/run_time.h"
#include "render/published.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

// More waves than these make a scribble of a trace.
double shown_end_s(const evaluation::RunRecord& run, double end_s) {
  constexpr double kMostPeriods = 60;
  return std::min(end_s, since_start_s(run, run.steady_begin_utime) + kMostPeriods * run.period_s);
}
std::string shown_text(double shown_s, double end_s) {
  return shown_s < end_s ? fmt::format("; shown: the first {:.0f} of {:.0f} s", shown_s, end_s) : "";
}

// Hundreds of percent need no hundredths.
std::string percent_text(double percent) {
  return number_text(percent, percent < 10 ? 2 : percent < 100 ? 1 : 0);
}

const char* calibration_text(bool calibrated) {
  return calibrated ? "accelerometer calibrated" : "accelerometer not calibrated (nominal sensitivities)";
}

bool steady(const evaluation::RunRecord& run, const estimator::Wave& wave) {
  return wave.start_utime >= run.steady_begin_utime &&
         wave.start_utime + static_cast<std::int64_t>(wave.period_s / kMicrosecond) <= run.steady_end_utime;
}

// What lies outside the steady part is shaded: it is in no statistics. name: in the legend.
void shade_ramps(const evaluation::RunRecord& run, double end_s, Panel& panel, std::string name) {
  if (run.steady_end_utime <= run.steady_begin_utime) return;
  const double begin_s = since_start_s(run, run.steady_begin_utime),
               steady_end_s = since_start_s(run, run.steady_end_utime);
  if (begin_s > 0) panel.marks.emplace_back(Span{.from = 0, .to = begin_s, .name = std::exchange(name, "")});
  if (end_s > steady_end_s) panel.marks.emplace_back(Span{.from = steady_end_s, .to = end_s, .name = name});
}

// A constant error of the acceleration makes a parabola of the trace.
struct Parabola {
  double middle_s, half_s;
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  Eigen::Vector3d row(double t) const {
    const double x = (t - middle_s) / half_s;
    return {1, x, x * x};
  }
  double at(double t) const { return row(t).dot(coefficients); }
  double acceleration_cmps2() const { return 2 * coefficients.z() / (half_s * half_s); }
};

// The best within [begin_s, end_s).
Parabola parabola_of(const Line& line, double begin_s, double end_s) {
  Parabola parabola{0.5 * (begin_s + end_s), std::max(1e-9, 0.5 * (end_s - begin_s))};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (line.x[i] < begin_s || line.x[i] >= end_s || !std::isfinite(line.y[i])) continue;
    const Eigen::Vector3d r = parabola.row(line.x[i]);
    normal += r * r.transpose();
    right += r * line.y[i];
  }
  parabola.coefficients = normal.ldlt().solve(right);
  return parabola;
}

// Without it the wave shows. Outside the steady part the trace is left out.
std::vector<double> less_parabola(const Line& line, double begin_s, double end_s) {
  const Parabola parabola = parabola_of(line, begin_s, end_s);
  std::vector<double> rest(line.x.size(), kAuto);
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (line.x[i] >= begin_s && line.x[i] < end_s) rest[i] = line.y[i] - parabola.at(line.x[i]);
  }
  return rest;
}

Line uncorrected_line(const evaluation::RunRecord& run, const PaperTraces& traces) {
  Line line{.name = "levelled acceleration, integrated twice", .look = {.color = 0}};
  for (const estimator::HeaveSample& sample : traces.heave) {
    line.x.push_back(since_start_s(run, sample.utime));
    line.y.push_back(sample.heave_m / kCentimetre);
  }
  return line;
}

// Eq (11) fits alpha cos + beta t + gamma to a wave. What it finds in the parabola b t^2 / 2 of a bias alone:
// alpha = b T^2 / (2 pi^2), a height of b T^2 / pi^2.
std::string bias_text(const evaluation::RunRecord& run, const PaperTraces& traces) {
  const double bias_mps2 =
      kCentimetre * parabola_of(uncorrected_line(run, traces), since_start_s(run, run.steady_begin_utime),
                                since_start_s(run, run.steady_end_utime))
                        .acceleration_cmps2();
  const double height_m = bias_mps2 * run.period_s * run.period_s / (std::numbers::pi * std::numbers::pi);
  return fmt::format(
      "\nacceleration off by b = {} m/s\u00B2, which alone adds b T\u00B2/\u03C0\u00B2 = {} cm to a height",
      number_text(bias_mps2, 3), number_text(height_m / kCentimetre, 0));
}

}  // namespace

PaperTraces recorded_traces(const evaluation::RunRecord& run, const std::string& method) {
  PaperTraces traces{.method = method, .imu = run.imu, .heave = {}, .waves = {}};
  if (const auto it = run.heave.find(method); it != run.heave.end()) traces.heave = it->second;
  if (const auto it = run.waves.find(method); it != run.waves.end()) traces.waves = it->second;
  return traces;
}

Figure inertial_data_figure(const evaluation::RunRecord& run, const PaperTraces& traces, bool calibrated) {
  Figure figure{.title = is_on_sea(run) ? "Inertial data measured on the buoy"
                                        : "Inertial data measured on the wave simulator",
                .share_x = true,
                .height_mm = 180};
  std::vector<double> attitude_s, roll_deg, pitch_deg;
  for (const estimator::HeaveSample& sample : traces.heave) {
    const Euler euler = euler_of(sample.q_NB);
    attitude_s.push_back(since_start_s(run, sample.utime));
    roll_deg.push_back(euler.roll_rad / kDegree);
    pitch_deg.push_back(euler.pitch_rad / kDegree);
  }
  std::vector<double> sample_s;
  std::array<std::vector<double>, 3> f_B;
  for (const estimator::ImuSample& sample : traces.imu) {
    sample_s.push_back(since_start_s(run, sample.utime));
    for (std::size_t axis = 0; axis < 3; ++axis)
      f_B[axis].push_back(sample.f_B[static_cast<Eigen::Index>(axis)]);
  }
  const double record_s = sample_s.empty() ? 0 : sample_s.back(), end_s = shown_end_s(run, record_s);
  figure.subtitle = setting_text(run) + shown_text(end_s, record_s) + "; " + calibration_text(calibrated);
  const Axis time{.label = "Time since the start of the record", .unit = "s", .low = 0, .high = end_s};
  const auto add = [&](const char* title, const char* label, const char* unit, const std::vector<double>& x,
                       std::vector<double> y, int color) {
    Panel panel{.title = title, .x = time, .y = {.label = label, .unit = unit}};
    const bool first = figure.panels.empty();
    shade_ramps(run, end_s, panel, first ? "rest and ramps" : "");
    panel.legend = first ? Legend::kAbove : Legend::kNone;
    panel.marks.emplace_back(Line{.x = x, .y = std::move(y), .look = {.color = color, .width_pt = 0.7}});
    figure.panels.push_back(std::move(panel));
  };
  add("(a) Roll", "Roll", "\u00B0", attitude_s, std::move(roll_deg), axis_color(0));  // roll turns about x
  add("(b) Pitch", "Pitch", "\u00B0", attitude_s, std::move(pitch_deg), axis_color(1));
  add("(c) Specific force f, x (forward)", "f", "m/s\u00B2", sample_s, std::move(f_B[0]), axis_color(0));
  add("(d) Specific force f, y (right)", "f", "m/s\u00B2", sample_s, std::move(f_B[1]), axis_color(1));
  add("(e) Specific force f, z (down)", "f", "m/s\u00B2", sample_s, std::move(f_B[2]), axis_color(2));
  return figure;
}

Figure uncorrected_trace_figure(const evaluation::RunRecord& run, const PaperTraces& traces,
                                bool calibrated) {
  Figure figure{.title = "Trace of the buoy before its errors are corrected",
                .subtitle = setting_text(run) + "; " + traces.method + ", " + calibration_text(calibrated),
                .share_x = true,
                .height_mm = 120};
  Line line = uncorrected_line(run, traces);
  Line truth{.name = "true heave", .look = {.color = kFaintInk, .width_pt = 0.8}};
  for (const evaluation::TruthSample& sample : run.truth) {
    truth.x.push_back(since_start_s(run, sample.utime));
    truth.y.push_back(sample.heave_m / kCentimetre);
  }
  const Axis time{.label = "Time since the start of the record",
                  .unit = "s",
                  .low = 0,
                  .high = line.x.empty() ? kAuto : line.x.back()};
  Panel whole{.title = "(a) As it is", .x = time, .y = {.label = "Heave", .unit = "cm"}};
  Panel rest{.title = "(b) Less the parabola that fits the steady part best",
             .x = time,
             .y = {.label = "Heave", .unit = "cm"},
             .legend = Legend::kNone};
  for (Panel* panel : {&whole, &rest})
    shade_ramps(run, line.x.empty() ? 0 : line.x.back(), *panel, "rest and ramps");
  rest.marks.emplace_back(Line{.x = line.x,
                               .y = less_parabola(line, since_start_s(run, run.steady_begin_utime),
                                                  since_start_s(run, run.steady_end_utime)),
                               .look = line.look});
  rest.marks.emplace_back(truth);
  whole.marks.emplace_back(std::move(line));
  whole.marks.emplace_back(std::move(truth));
  figure.panels = {std::move(whole), std::move(rest)};
  return figure;
}

Figure corrected_trace_figure(const evaluation::RunRecord& run, const PaperTraces& traces, bool calibrated) {
  constexpr double kSampleS = 0.05;  // fine enough to draw a wave with
  Line trace{.name = "corrected trace, crests at zero", .look = {.color = 0}};
  Points steady_heights{.name = "single waves",
                        .look = {.color = 0, .marker = Marker::kCircle, .marker_pt = 3.5}};
  Points other_heights{.name = "not wholly in the steady part",
                       .look = {.color = 0, .marker = Marker::kHollowCircle, .marker_pt = 3.5}};
  double n = 0, sum_m = 0, square_m2 = 0;
  for (const estimator::Wave& wave : traces.waves) {
    const double begin_s = since_start_s(run, wave.start_utime);
    const double omega = 2 * std::numbers::pi / wave.period_s, alpha_cm = 0.5 * wave.height_m / kCentimetre;
    for (double t = 0; t < wave.period_s; t += kSampleS) {
      trace.x.push_back(begin_s + t);
      trace.y.push_back(alpha_cm * (std::cos(omega * t) - 1));  // Lee 2014, eq (13), P_hat0
    }
    const bool counted = steady(run, wave);
    Points& heights = counted ? steady_heights : other_heights;
    heights.x.push_back(begin_s + 0.5 * wave.period_s);
    heights.y.push_back(wave.height_m / kCentimetre);
    if (!counted) continue;
    ++n;
    sum_m += wave.height_m;
    square_m2 += wave.height_m * wave.height_m;
  }
  const bool sea = is_on_sea(run);
  const double mean_m = n > 0 ? sum_m / n : kAuto;
  const double std_m = n > 1 ? std::sqrt(std::max(0.0, (square_m2 - n * mean_m * mean_m) / (n - 1))) : kAuto;
  std::string statistics = "no steady waves";
  if (n > 0) {
    // Of an irregular sea no single height is set that the mean could miss.
    const std::string error =
        sea ? ""
            : fmt::format("error rate {} %, ",
                          percent_text(100 * std::abs(mean_m - run.height_m) / run.height_m));
    statistics = fmt::format("mean {:.2f} cm, {}", mean_m / kCentimetre, error);
    statistics += n > 1
                      ? fmt::format("standard deviation {:.2f} cm over {:.0f} waves", std_m / kCentimetre, n)
                      : "of a single wave";
  }
  const PublishedCell& published = calibrated ? kPublishedCalibrated : kPublishedUncalibrated;
  if (!sea && published_cell(run.period_s, run.height_m) != nullptr && run.period_s == published.period_s &&
      run.height_m == published.height_m) {
    statistics += fmt::format(
        "\npublished: mean {:.2f} cm, error rate {:.2f} "
        "%, standard deviation {:.2f} cm",
        published.mean_height_m / kCentimetre, published.error_rate_percent, published.std_m / kCentimetre);
  }
  if (!calibrated && !sea && !traces.heave.empty()) statistics += bias_text(run, traces);
  Figure figure{.title = calibrated ? "Trace and wave heights with the accelerometer calibrated"
                                    : "Trace and wave heights without accelerometer calibration",
                .share_x = true,
                .height_mm = 125};
  double record_s = trace.x.empty() ? 0 : trace.x.back();
  Line truth{.name = sea ? "true heave less half of Hm0" : "true heave less half the set height",
             .look = {.color = kFaintInk, .width_pt = 0.7}};
  for (const evaluation::TruthSample& sample : run.truth) {
    truth.x.push_back(since_start_s(run, sample.utime));
    truth.y.push_back((sample.heave_m - 0.5 * run.height_m) / kCentimetre);
    record_s = std::max(record_s, truth.x.back());
  }
  const double end_s = shown_end_s(run, record_s);
  figure.subtitle =
      setting_text(run) + shown_text(end_s, record_s) + "\n" + traces.method + ": " + statistics;
  const Axis time{.label = "Time since the start of the record", .unit = "s", .low = 0, .high = end_s};
  Panel top{.title = "(a) Trace of the buoy", .x = time, .y = {.label = "Heave", .unit = "cm"}};
  shade_ramps(run, end_s, top, "");
  top.marks.emplace_back(std::move(truth));
  top.marks.emplace_back(std::move(trace));
  top.legend = Legend::kAbove;
  Panel bottom{.title = "(b) Wave height", .x = time, .y = {.label = "Wave height", .unit = "cm"}};
  shade_ramps(run, end_s, bottom, "rest and ramps, left out of the statistics");
  bottom.marks.emplace_back(Rule{.at = run.height_m / kCentimetre, .name = sea ? "set Hm0" : "set height"});
  bottom.marks.emplace_back(std::move(other_heights));
  bottom.marks.emplace_back(std::move(steady_heights));
  bottom.legend = Legend::kAbove;
  figure.panels = {std::move(top), std::move(bottom)};
  return figure;
}

}  // namespace waverig::render
