#include "estimator/waves/wave_finder.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace waverig::estimator {
namespace {

using std::numbers::pi;

constexpr double kSight_periods = 1.8;                       // half width of the local fit
constexpr double kStep_periods = 0.125;                      // between two local fits
constexpr double kShortestRatio = 0.6, kLongestRatio = 1.7;  // of the dominant period

// Line through the bins, for detrending: value at t = 0 and slope.
std::pair<double, double> line_through(const WaveSeries& series) {
  double n = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (const Bin& bin : series.bins()) {
    const double tau = bin.t_s - series.begin_s();
    n += bin.count, t += bin.count * tau, y += bin.count * bin.up_mps2;
    tt += bin.count * tau * tau, ty += bin.count * tau * bin.up_mps2;
  }
  const double det = n * tt - t * t;
  const double slope = det > 0 ? (n * ty - t * y) / det : 0;
  return {(y - slope * t) / n, slope};
}

}  // namespace

std::optional<double> dominant_period_s(const WaveSeries& series, const WaveFinderSettings& settings) {
  if (series.bins().size() < 16) return std::nullopt;
  const auto [offset, slope] = line_through(series);
  const std::int64_t first = series.bins().front().index;
  const auto length = static_cast<std::size_t>(series.bins().back().index - first + 1);
  std::size_t padded = 256;
  while (padded < 2 * length) padded *= 2;
  std::vector<double> signal(padded, 0.0);
  for (const Bin& bin : series.bins()) {
    const auto i = static_cast<std::size_t>(bin.index - first);
    const double hann =
        0.5 - 0.5 * std::cos(2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(length));
    signal[i] = hann * (bin.up_mps2 - offset - slope * (bin.t_s - series.begin_s()));
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, signal);

  const double df = 1 / (series.bin_s() * static_cast<double>(padded));
  const auto low = static_cast<std::size_t>(std::ceil(1 / (settings.longest_period_s * df)));
  const auto high =
      std::min(spectrum.size() - 2, static_cast<std::size_t>(1 / (settings.shortest_period_s * df)));
  if (low < 1 || low + 3 > high) return std::nullopt;
  std::vector<double> power(high + 2);
  for (std::size_t k = low - 1; k < power.size(); ++k) power[k] = std::norm(spectrum[k]);
  std::vector<double> sorted(power.begin() + static_cast<std::ptrdiff_t>(low), power.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());

  std::size_t best = 0;
  double strongest = 0;
  for (std::size_t k = low; k <= high; ++k) {
    const double velocity = power[k] / static_cast<double>(k * k);
    const bool peak = power[k] >= power[k - 1] && power[k] >= power[k + 1];
    if (!peak || power[k] < settings.significance * *middle || velocity <= strongest) continue;
    strongest = velocity;
    best = k;
  }
  if (best == 0) return std::nullopt;
  const double a = power[best - 1], b = power[best], c = power[best + 1];
  const double curvature = a - 2 * b + c;
  const double shift = curvature < 0 ? 0.5 * (a - c) / curvature : 0;
  return 1 / ((static_cast<double>(best) + std::clamp(shift, -0.5, 0.5)) * df);
}

std::vector<WaveSpan> find_waves(const WaveSeries& series, double period_s) {
  const std::deque<Bin>& bins = series.bins();
  const double w = 2 * pi / period_s, sight_s = kSight_periods * period_s, step_s = kStep_periods * period_s;
  std::vector<double> cosine(bins.size()), sine(bins.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    cosine[i] = std::cos(w * bins[i].t_s);
    sine[i] = std::sin(w * bins[i].t_s);
  }

  std::vector<WaveSpan> spans;
  std::size_t first = 0, last = 0;
  bool tracked = false;
  double slow_phase = 0, cycles = 0, crossing_s = 0;
  bool crossed = false, follows = false;
  for (double t_s = series.begin_s(); t_s <= series.end_s(); t_s += step_s) {
    while (first < bins.size() && bins[first].t_s < t_s - sight_s) ++first;
    while (last < bins.size() && bins[last].t_s < t_s + sight_s) ++last;
    // Local fit of a cos + b sin + offset + drift; needs data on both sides of t, or the phase would be a
    // guess.
    Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
    Eigen::Vector4d y = Eigen::Vector4d::Zero();
    double near = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double tau = (bins[i].t_s - t_s) / sight_s, taper = 1 - tau * tau;
      const double weight = bins[i].count * taper * taper;
      const Eigen::Vector4d row(cosine[i], sine[i], 1.0, tau);
      N.noalias() += weight * row * row.transpose();
      y.noalias() += weight * bins[i].up_mps2 * row;
      if (std::abs(bins[i].t_s - t_s) < 0.25 * period_s) near += series.bin_s();
    }
    if (near < 0.2 * period_s) {
      tracked = crossed = false;
      continue;
    }
    const Eigen::Vector4d fit = N.ldlt().solve(y);
    const double raw_phase = std::atan2(-fit(1), fit(0));  // a = Re{(c - i s) e^{i w t}}
    slow_phase = tracked ? slow_phase + std::remainder(raw_phase - slow_phase, 2 * pi) : raw_phase;
    // Heave is opposite to acceleration (+ pi) and crosses upward where its phase is -pi/2.
    const double cycles_now = (w * t_s + slow_phase + pi + 0.5 * pi) / (2 * pi);
    if (tracked && std::floor(cycles_now) > std::floor(cycles)) {
      const double at_s = t_s - step_s * (cycles_now - std::floor(cycles_now)) / (cycles_now - cycles);
      const double lasts = (at_s - crossing_s) / period_s;
      if (crossed && lasts > kShortestRatio && lasts < kLongestRatio) {
        spans.push_back({crossing_s, at_s, follows});
        follows = true;
      } else {
        follows = false;
      }
      crossing_s = at_s;
      crossed = true;
    }
    cycles = cycles_now;
    if (!tracked) follows = false;
    tracked = true;
  }
  return spans;
}

}  // namespace waverig::estimator
