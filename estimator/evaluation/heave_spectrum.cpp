#include "estimator/evaluation/heave_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/evaluation/even_series.h"
#include "estimator/real_transform.h"

namespace waverig::evaluation {
namespace {

constexpr std::size_t kFewest = 16;

// Offset and slope of a block, which a window alone lets through at the lowest frequencies.
void remove_line(std::span<double> x) {
  const auto n = static_cast<double>(x.size());
  double mean = 0, slope = 0, squares = 0;
  for (const double value : x) mean += value / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) - (n - 1) / 2;
    slope += t * x[i];
    squares += t * t;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] -= mean + slope / squares * (static_cast<double>(i) - (n - 1) / 2);
}

}  // namespace

HeaveSpectrum spectrum_of(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                          const HeaveSpectrumSettings& settings) {
  Interpolated series(utime, heave_m);
  if (series.known() < kFewest) return {};
  const std::int64_t step = median_interval(utime);
  if (mostly_gap(series.begin(), series.end(), step, series.known())) return {};
  std::vector<double> even;
  for (std::int64_t t = series.begin(); t <= series.end(); t += step) even.push_back(series.at(t));
  const double step_s = static_cast<double>(step) * kMicrosecond;

  const auto wanted = static_cast<std::size_t>(std::llround(settings.block_s / step_s));
  const std::size_t size = std::clamp(wanted, std::min(kFewest, even.size()), even.size());
  std::vector<double> window(size);
  double window_power = 0;
  for (std::size_t i = 0; i < size; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                     static_cast<double>(size));
    window_power += window[i] * window[i];
  }
  // Half-overlapped blocks, spread so that the last one ends with the record.
  const std::size_t blocks = std::max<std::size_t>(1, (2 * even.size()) / size - 1);
  estimator::RealTransform transform(size);
  std::vector<double> power(size / 2 + 1, 0.0), block(size);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = blocks == 1 ? 0 : b * (even.size() - size) / (blocks - 1);
    std::copy_n(even.begin() + static_cast<std::ptrdiff_t>(first), size, block.begin());
    remove_line(block);
    for (std::size_t i = 0; i < size; ++i) transform.in()[i] = window[i] * block[i];
    transform.execute();
    for (std::size_t k = 0; k < power.size(); ++k)
      power[k] += transform.power(k) / static_cast<double>(blocks);
  }

  HeaveSpectrum spectrum;
  spectrum.start_utime = series.begin();
  spectrum.duration_s = static_cast<double>(series.end() - series.begin()) * kMicrosecond;
  spectrum.resolution_hz = 1 / (static_cast<double>(size) * step_s);
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double f = static_cast<double>(k) * spectrum.resolution_hz;
    if (f < settings.lowest_hz || f > settings.highest_hz) continue;
    spectrum.frequency_hz.push_back(f);
    spectrum.density_m2_per_hz.push_back(2 * power[k] * step_s / window_power);
  }
  return spectrum;
}

estimator::SeaState sea_of(const HeaveSpectrum& spectrum) {
  estimator::SeaState sea;
  sea.start_utime = spectrum.start_utime;
  sea.duration_s = spectrum.duration_s;
  double inverse = 0, m0 = 0, m1 = 0, m2 = 0, peak = 0, peak_frequency = 0;
  const double highest =
      spectrum.density_m2_per_hz.empty()
          ? 0.0
          : *std::max_element(spectrum.density_m2_per_hz.begin(), spectrum.density_m2_per_hz.end());
  if (!(highest > 0)) return sea;
  for (std::size_t i = 0; i < spectrum.frequency_hz.size(); ++i) {
    const double f = spectrum.frequency_hz[i],
                 variance = spectrum.density_m2_per_hz[i] * spectrum.resolution_hz;
    inverse += variance / f;
    m0 += variance;
    m1 += variance * f;
    m2 += variance * f * f;
    const double weight = std::pow(spectrum.density_m2_per_hz[i] / highest, 4);
    peak += weight;
    peak_frequency += weight * f;
  }
  sea.hm0_m = 4 * std::sqrt(m0);
  sea.tm01_s = m0 / m1;
  sea.tm02_s = std::sqrt(m0 / m2);
  sea.tm_10_s = inverse / m0;
  sea.tp_s = peak / peak_frequency;
  return sea;
}

}  // namespace waverig::evaluation
