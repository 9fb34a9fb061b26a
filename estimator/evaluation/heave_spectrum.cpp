#include "estimator/evaluation/heave_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/evaluation/even_series.h"
#include "estimator/real_transform.h"
#include "lcmtypes/flags.h"

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

bool within(double f_hz, const HeaveSpectrumSettings& settings) {
  return f_hz >= settings.lowest_hz && f_hz <= settings.highest_hz;
}

// Of a whole piece, without a window: mean square of what lies between the lowest and the highest frequency.
double mean_square(std::vector<double> heave_m, double step_s, const HeaveSpectrumSettings& settings) {
  remove_line(heave_m);
  const std::size_t n = heave_m.size();
  estimator::RealTransform transform(n);
  std::copy(heave_m.begin(), heave_m.end(), transform.in().begin());
  transform.execute();
  double sum = 0;
  for (std::size_t k = 1; k <= n / 2; ++k)
    if (within(static_cast<double>(k) / (static_cast<double>(n) * step_s), settings))
      sum += (2 * k == n ? 1 : 2) * transform.power(k);
  return sum / estimator::square(static_cast<double>(n));
}

}  // namespace

HeaveSpectrum spectrum_of(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                          const HeaveSpectrumSettings& settings) {
  const std::vector<std::vector<double>> pieces = even_pieces(utime, heave_m);
  std::size_t longest = 0;
  for (const auto& piece : pieces) longest = std::max(longest, piece.size());
  HeaveSpectrum spectrum;
  const auto is_known = [](double h) { return std::isfinite(h); };
  if (pieces.size() > 1 || !std::all_of(heave_m.begin(), heave_m.end(), is_known))
    spectrum.flags |= flag::kGap;
  if (longest < kFewest) return spectrum;
  const double step_s = static_cast<double>(median_interval(utime)) * kMicrosecond;

  const auto wanted = static_cast<std::size_t>(std::llround(settings.block_s / step_s));
  const std::size_t size = std::clamp(wanted, kFewest, longest);
  std::vector<double> window(size);
  double window_power = 0;
  for (std::size_t i = 0; i < size; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                     static_cast<double>(size));
    window_power += window[i] * window[i];
  }
  estimator::RealTransform transform(size);
  std::vector<double> power(size / 2 + 1, 0.0), block(size);
  // What is shorter than the longest period has no mean square of its own.
  const double shortest = std::min(static_cast<double>(longest), 1 / (settings.lowest_hz * step_s));
  double squares = 0, samples = 0, blocks = 0;
  for (const auto& piece : pieces) {
    const auto n = static_cast<double>(piece.size());
    if (n < shortest) continue;
    squares += n * mean_square(piece, step_s, settings);
    samples += n;
    if (piece.size() < size) continue;
    // Half-overlapped blocks, spread so that the last one ends with the piece.
    const std::size_t count = std::max<std::size_t>(1, (2 * piece.size()) / size - 1);
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t first = count == 1 ? 0 : b * (piece.size() - size) / (count - 1);
      std::copy_n(piece.begin() + static_cast<std::ptrdiff_t>(first), size, block.begin());
      remove_line(block);
      for (std::size_t i = 0; i < size; ++i) transform.in()[i] = window[i] * block[i];
      transform.execute();
      for (std::size_t k = 0; k < power.size(); ++k) power[k] += transform.power(k);
      blocks += 1;
    }
  }

  const auto first_known = std::find_if(heave_m.begin(), heave_m.end(), is_known);
  spectrum.start_utime = utime[static_cast<std::size_t>(first_known - heave_m.begin())];
  spectrum.duration_s = (samples - 1) * step_s;
  spectrum.resolution_hz = 1 / (static_cast<double>(size) * step_s);
  double windowed = 0;
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double f = static_cast<double>(k) * spectrum.resolution_hz;
    if (!within(f, settings)) continue;
    spectrum.frequency_hz.push_back(f);
    spectrum.density_m2_per_hz.push_back(2 * power[k] / blocks * step_s / window_power);
    windowed += spectrum.density_m2_per_hz.back() * spectrum.resolution_hz;
  }
  if (windowed > 0)
    for (double& density : spectrum.density_m2_per_hz) density *= squares / samples / windowed;
  return spectrum;
}

estimator::SeaState sea_of(const HeaveSpectrum& spectrum) {
  estimator::SeaState sea;
  sea.start_utime = spectrum.start_utime;
  sea.duration_s = spectrum.duration_s;
  sea.flags = spectrum.flags;
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
