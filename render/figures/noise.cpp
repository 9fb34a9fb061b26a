#include "render/figures/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "estimator/calibration/allan.h"
#include "render/figures/methods.h"
#include "render/figures/run_time.h"
#include "render/marks.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

template <class Sample>
double median_interval_s(const std::vector<Sample>& samples) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].utime - samples[i - 1].utime);
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return static_cast<double>(steps[steps.size() / 2]) * kMicrosecond;
}

// Pools the records of one axis: variances weighted with their degrees of
// freedom.
std::vector<estimator::AllanPoint> pooled(const std::vector<RestRecord>& records, std::size_t axis) {
  std::vector<estimator::AllanPoint> sum;
  for (const RestRecord& record : records) {
    const std::vector<estimator::AllanPoint> points =
        estimator::allan_deviation(record.axes[axis], record.interval_s);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i >= sum.size()) sum.push_back({points[i].tau_s, 0, 0});
      sum[i].deviation += points[i].degrees * points[i].deviation * points[i].deviation;
      sum[i].degrees += points[i].degrees;
    }
  }
  for (estimator::AllanPoint& p : sum)
    p.deviation = p.degrees > 0 ? std::sqrt(p.deviation / p.degrees) : kAuto;
  return sum;
}

// The curve of the four terms together.
double deviation_of(const estimator::AllanTerms& t, double tau_s) {
  return std::sqrt(3 * t.quantisation * t.quantisation / (tau_s * tau_s) +
                   t.random_walk * t.random_walk / tau_s +
                   2 * std::numbers::ln2 / std::numbers::pi * t.bias_instability * t.bias_instability +
                   t.rate_random_walk * t.rate_random_walk * tau_s / 3);
}

struct Quantity {
  const char *title, *unit, *noise_unit;
  double scale;  // from SI to the axis and to the terms in the legend
};

Panel allan_panel(const std::vector<RestRecord>& records, const Quantity& q) {
  Panel panel{.title = q.title,
              .x = {.label = "Averaging time \u03C4", .unit = "s", .scale = Scale::kLog},
              .y = {.label = "Allan deviation", .unit = q.unit, .scale = Scale::kLog},
              .legend = Legend::kFree};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int color = axis_color(axis);
    const std::vector<estimator::AllanPoint> points = pooled(records, axis);
    const estimator::AllanTerms terms = estimator::fit_allan(points);
    Points measured{.look = {.color = color, .marker = Marker::kCircle, .marker_pt = 3.5}};
    Band band{.look = {.color = color, .alpha = 0.15}};
    Line fit{.look = {.color = color, .width_pt = 0.9}};
    for (const estimator::AllanPoint& p : points) {
      if (!(p.deviation > 0)) continue;
      const double shown = q.scale * p.deviation,
                   u = 1 / std::sqrt(2 * std::max(1.0, p.degrees));  // one sigma, relative
      measured.x.push_back(p.tau_s);
      measured.y.push_back(shown);
      band.x.push_back(p.tau_s);
      band.low.push_back(shown * std::max(0.05, 1 - u));
      band.high.push_back(shown * (1 + u));
      fit.x.push_back(p.tau_s);
      fit.y.push_back(q.scale * deviation_of(terms, p.tau_s));
    }
    std::string name = fmt::format("{}: N {} {}", kAxisNames[axis],
                                   significant_text(q.scale * terms.one_sided_density(), 3), q.noise_unit);
    if (terms.bias_instability > 0)
      name += fmt::format(", B {} {}", significant_text(q.scale * terms.bias_instability, 2), q.unit);
    measured.name = fit.name = name;
    panel.marks.emplace_back(std::move(band));
    panel.marks.emplace_back(std::move(fit));
    panel.marks.emplace_back(std::move(measured));
  }
  return panel;
}

// Mean power in bands of a twelfth of an octave: a floor becomes a line, and
// single bins of low frequency stay.
Spectrum banded(const Spectrum& s) {
  const double ratio = std::pow(2.0, 1.0 / 12);
  Spectrum out;
  for (std::size_t i = 0; i < s.frequency_hz.size();) {
    double power = 0, log_frequency = 0;
    std::size_t n = 0;
    for (const double end = s.frequency_hz[i] * ratio;
         i < s.frequency_hz.size() && (n == 0 || s.frequency_hz[i] < end); ++i, ++n) {
      power += s.density_rthz[i] * s.density_rthz[i];
      log_frequency += std::log(s.frequency_hz[i]);
    }
    out.frequency_hz.push_back(std::exp(log_frequency / static_cast<double>(n)));
    out.density_rthz.push_back(std::sqrt(power / static_cast<double>(n)));
  }
  return out;
}

// Where the axis of a spectrum begins. A simulated truth falls by ten decades and more: what counts is near
// its peak.
double least_density(const std::vector<double>& truth) {
  constexpr double kShown = 1e-6;  // of the peak
  const auto [least, most] = std::ranges::minmax_element(truth);
  return least != truth.end() && *least < kShown * *most ? kShown * *most : kAuto;
}

// The longest part of the samples with all values known: one unknown value would make a whole transform
// unknown. Where no more than `bridged` are missing, as at the seams between the waves of harmonic, a
// straight line stands for them.
template <class Sample, class Value>
std::vector<double> longest_known(const std::vector<Sample>& samples, std::size_t bridged, Value value) {
  std::vector<double> longest, part;
  std::size_t missing = 0;
  for (const Sample& sample : samples) {
    const double v = value(sample);
    if (!std::isfinite(v)) {
      ++missing;
      continue;
    }
    if (missing > bridged) {
      if (part.size() > longest.size()) longest.swap(part);
      part.clear();
    }
    if (!part.empty()) {
      const double before = part.back();
      for (std::size_t k = 1; k <= missing; ++k)
        part.push_back(std::lerp(before, v, static_cast<double>(k) / static_cast<double>(missing + 1)));
    }
    missing = 0;
    part.push_back(v);
  }
  return part.size() > longest.size() ? part : longest;
}

}  // namespace

RestRecords rest_of(const evaluation::RunRecord& run) {
  constexpr double kStillM = 2e-4, kShortestS = 2;
  RestRecords rest;
  if (run.truth.empty() || run.imu.empty()) return rest;
  std::int64_t end_utime = run.truth.back().utime;
  for (const evaluation::TruthSample& sample : run.truth) {
    if (std::abs(sample.heave_m - run.truth.front().heave_m) <= kStillM) continue;
    end_utime = sample.utime;
    break;
  }
  const double interval_s = median_interval_s(run.imu);
  RestRecord force{.interval_s = interval_s, .axes = {}}, rate = force;
  for (std::size_t i = 0; i < run.imu.size() && run.imu[i].utime < end_utime; ++i) {
    if (i > 0 &&
        static_cast<double>(run.imu[i].utime - run.imu[i - 1].utime) * kMicrosecond > 1.5 * interval_s)
      break;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      force.axes[axis].push_back(run.imu[i].f_B[static_cast<Eigen::Index>(axis)]);
      rate.axes[axis].push_back(run.imu[i].w_NB_B[static_cast<Eigen::Index>(axis)]);
    }
  }
  if (static_cast<double>(force.axes[0].size()) * interval_s < kShortestS) return rest;
  rest.specific_force_mps2.push_back(std::move(force));
  rest.angular_rate_radps.push_back(std::move(rate));
  return rest;
}

void append(RestRecords& to, RestRecords&& from) {
  for (RestRecord& r : from.specific_force_mps2) to.specific_force_mps2.push_back(std::move(r));
  for (RestRecord& r : from.angular_rate_radps) to.angular_rate_radps.push_back(std::move(r));
}

Figure allan_figure(const RestRecords& rest, bool calibrated) {
  double longest_s = 0;
  for (const RestRecord& r : rest.specific_force_mps2)
    longest_s = std::max(longest_s, r.interval_s * static_cast<double>(r.axes[0].size()));
  Figure figure{
      .title = "Allan deviation of the sensors at rest",
      .subtitle = fmt::format(
          "samples {}, {} record{} of {:.0f} s; bands: one standard deviation; "
          "lines: fitted noise, N its one-sided white density, B its bias instability",
          calibrated ? "calibrated" : "as recorded, without a calibration of the campaign",
          rest.specific_force_mps2.size(), rest.specific_force_mps2.size() == 1 ? "" : "s", longest_s),
      .columns = 2,
      .height_mm = 100};
  constexpr double kMicroG = kStandardGravity * 1e-6;
  figure.panels.push_back(allan_panel(rest.specific_force_mps2,
                                      {"(a) Accelerometer", "\u00B5g", "\u00B5g/\u221AHz", 1 / kMicroG}));
  figure.panels.push_back(allan_panel(rest.angular_rate_radps,
                                      {"(b) Gyroscope", "\u00B0/s", "(\u00B0/s)/\u221AHz", 1 / kDegree}));
  return figure;
}

Spectrum welch(std::span<const double> values, double interval_s, std::size_t block) {
  Spectrum out;
  block = std::min(block, values.size());
  if (block < 8 || !(interval_s > 0)) return out;
  std::vector<double> window(block), windowed(block), power(block / 2 + 1, 0.0);
  double window_power = 0;
  for (std::size_t i = 0; i < block; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                     static_cast<double>(block));
    window_power += window[i] * window[i];
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> bins;
  int blocks = 0;
  for (std::size_t begin = 0; begin + block <= values.size();
       begin += std::max<std::size_t>(1, block / 2), ++blocks) {
    double mean = 0;
    for (std::size_t i = 0; i < block; ++i) mean += values[begin + i] / static_cast<double>(block);
    for (std::size_t i = 0; i < block; ++i) windowed[i] = window[i] * (values[begin + i] - mean);
    fft.fwd(bins, windowed);
    for (std::size_t k = 0; k < power.size(); ++k) power[k] += std::norm(bins[k]);
  }
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double sides = 2 * k == block ? 1 : 2;
    out.frequency_hz.push_back(static_cast<double>(k) / (static_cast<double>(block) * interval_s));
    out.density_rthz.push_back(std::sqrt(sides * power[k] * interval_s / (window_power * blocks)));
  }
  return out;
}

Figure spectra_figure(const evaluation::RunRecord& run, double noise_density_mps2_rthz,
                      const std::vector<std::string>& methods) {
  Figure figure{.title = "Spectra of the steady part", .columns = 2, .height_mm = 100};
  Extent blocks;  // in periods; a record that is too short for ten is one block
  const auto spectrum_of = [&](const auto& samples, auto value) {
    constexpr double kBridged = 0.02;  // of a period: a line is within 0.2 % of its amplitude there
    const double interval_s = median_interval_s(samples);
    const auto in_periods = [&](double n) {
      return interval_s > 0 ? static_cast<std::size_t>(n * run.period_s / interval_s) : 0;
    };
    const std::vector<double> values = longest_known(samples, in_periods(kBridged), [&](const auto& sample) {
      const bool steady = sample.utime >= run.steady_begin_utime && sample.utime < run.steady_end_utime;
      return steady ? value(sample) : kAuto;
    });
    if (values.size() < 16) return Spectrum{};
    const std::size_t block = std::min(2 * in_periods(5), values.size());
    blocks.add(static_cast<double>(block) * interval_s / run.period_s);
    return banded(welch(values, interval_s, block));
  };
  Panel force{.title = "(a) Specific force",
              .x = {.label = "Frequency", .unit = "Hz", .scale = Scale::kLog},
              .y = {.label = "Density", .unit = "m/s\u00B2/\u221AHz", .scale = Scale::kLog}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Spectrum s =
        spectrum_of(run.imu, [&](const auto& sample) { return sample.f_B[static_cast<Eigen::Index>(axis)]; });
    force.marks.emplace_back(Line{.x = s.frequency_hz,
                                  .y = s.density_rthz,
                                  .name = fmt::format("f {}", kAxisNames[axis]),
                                  .look = {.color = axis_color(axis), .width_pt = 0.8}});
  }
  if (noise_density_mps2_rthz > 0)
    force.marks.emplace_back(Rule{.at = noise_density_mps2_rthz,
                                  .name = "noise floor",
                                  .look = {.color = kInk, .width_pt = 1, .dash = Dash::kDashed}});
  Panel heave{.title = "(b) Heave",
              .x = force.x,
              .y = {.label = "Density", .unit = "m/\u221AHz", .scale = Scale::kLog}};
  const auto add = [&](const std::string& name, int color, const auto& samples, Dash dash) {
    const Spectrum s = spectrum_of(samples, [](const auto& sample) { return sample.heave_m; });
    heave.marks.emplace_back(Line{.x = s.frequency_hz,
                                  .y = s.density_rthz,
                                  .name = name,
                                  .look = {.color = color, .width_pt = 0.9, .dash = dash}});
    return s.density_rthz;
  };
  std::string without;
  for (const std::string& method : heave_methods_of(run)) {
    if (add(method, method_color(methods, method), run.heave.at(method), Dash::kSolid).empty())
      without += (without.empty() ? "" : ", ") + method;
  }
  if (!without.empty())
    heave.marks.emplace_back(
        Note{.x = 0.02, .y = 0.97, .text = "no steady heave: " + without, .color = kFaintInk});
  draw_same_once(heave.marks);
  heave.y.low = least_density(add("truth", kInk, run.truth, Dash::kDashed));
  force.legend = heave.legend = Legend::kAbove;
  const std::string least = significant_text(blocks.low, 2), most = significant_text(blocks.high, 2);
  figure.subtitle = fmt::format("{}; Hann blocks of {} periods, means over 1/12 octave", setting_text(run),
                                least == most ? most : least + " to " + most);
  figure.panels = {std::move(force), std::move(heave)};
  return figure;
}

}  // namespace waverig::render
