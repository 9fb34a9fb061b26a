#include "estimator/evaluation/zero_crossing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/evaluation/even_series.h"

namespace waverig::evaluation {
namespace {

// The zero line, level + slope * (seconds since the first sample).
struct ZeroLine {
  double level_m = 0, slope_mps = 0;
};

double seconds(std::int64_t from, std::int64_t to) { return static_cast<double>(to - from) * kMicrosecond; }

ZeroLine zero_line(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                   const ZeroCrossingSettings& settings) {
  ZeroLine line{settings.level_m, 0};
  if (!settings.remove_mean && !settings.remove_trend) return line;
  double n = 0, sum_t = 0, sum_h = 0;
  for (std::size_t i = 0; i < utime.size(); ++i) {
    if (!std::isfinite(heave_m[i])) continue;
    n += 1;
    sum_t += seconds(utime[0], utime[i]);
    sum_h += heave_m[i];
  }
  if (n == 0) return line;
  const double mean_t = sum_t / n, mean_h = sum_h / n;
  if (settings.remove_trend) {
    double tt = 0, th = 0;
    for (std::size_t i = 0; i < utime.size(); ++i) {
      if (!std::isfinite(heave_m[i])) continue;
      const double t = seconds(utime[0], utime[i]) - mean_t;
      tt += t * t;
      th += t * (heave_m[i] - mean_h);
    }
    if (tt > 0) line.slope_mps = th / tt;
  }
  line.level_m += mean_h - line.slope_mps * mean_t;
  return line;
}

// An up-crossing: its interpolated time and the first sample at or above the zero line.
struct Crossing {
  std::int64_t utime;
  std::size_t sample;
};

// h: heave above the zero line, without gaps, samples [begin, end).
std::vector<Crossing> up_crossings(std::span<const std::int64_t> utime, std::span<const double> h,
                                   std::size_t begin, std::size_t end, double dead_band_m) {
  std::vector<Crossing> crossings;
  enum class Side { kUnknown, kBelow, kAbove } side = Side::kUnknown;
  Crossing last{};  // newest change of sign, which counts only once the dead band is left
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin && h[i - 1] < 0 && h[i] >= 0) {
      const double fraction = h[i - 1] / (h[i - 1] - h[i]);
      last = {utime[i - 1] + std::llround(fraction * static_cast<double>(utime[i] - utime[i - 1])), i};
    }
    if (h[i] < -dead_band_m) {
      side = Side::kBelow;
    } else if (h[i] >= dead_band_m) {
      if (side == Side::kBelow) crossings.push_back(last);
      side = Side::kAbove;
    }
  }
  return crossings;
}

// Height of the parabola's vertex through the sample at `top` and its neighbours; sign +1 for a crest, -1 for
// a trough.
double extreme(std::span<const double> h, std::size_t top, double sign, bool interpolate) {
  if (!interpolate || top == 0 || top + 1 >= h.size()) return h[top];
  const double before = sign * h[top - 1], after = sign * h[top + 1], here = sign * h[top];
  const double curvature = before - 2 * here + after, slope = after - before;
  if (!(curvature < 0) || before > here || after > here) return h[top];
  return sign * (here - slope * slope / (8 * curvature));
}

// Nobody's heave is exact: a sigma of zero states nothing.
double stated(std::span<const double> sigma_m, std::size_t i) {
  return !sigma_m.empty() && sigma_m[i] > 0 ? sigma_m[i] : estimator::kUnknown;
}

}  // namespace

std::vector<CountedWave> count_waves(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                                     const ZeroCrossingSettings& settings,
                                     std::span<const double> heave_sigma_m) {
  const ZeroLine line = zero_line(utime, heave_m, settings);
  std::vector<double> h(heave_m.size());
  for (std::size_t i = 0; i < h.size(); ++i)
    h[i] = heave_m[i] - line.level_m - line.slope_mps * seconds(utime[0], utime[i]);
  const std::int64_t longest = utime.size() < 2 ? 0 : longest_step(utime);

  std::vector<CountedWave> waves;
  for (std::size_t begin = 0; begin < h.size();) {
    std::size_t end = begin;  // the piece without a gap that begins here
    while (end < h.size() && std::isfinite(h[end]) &&
           (end == begin || utime[end] - utime[end - 1] <= longest))
      ++end;
    const auto crossings = up_crossings(utime, h, begin, end, settings.dead_band_m);
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
      const auto first = h.begin() + static_cast<std::ptrdiff_t>(crossings[k].sample);
      const auto last = h.begin() + static_cast<std::ptrdiff_t>(crossings[k + 1].sample);
      const auto [low, high] = std::minmax_element(first, last);
      const auto top = static_cast<std::size_t>(high - h.begin()),
                 bottom = static_cast<std::size_t>(low - h.begin());
      const double crest = extreme(h, top, +1, settings.interpolate_extremes);
      const double trough = extreme(h, bottom, -1, settings.interpolate_extremes);
      waves.push_back({crossings[k].utime, seconds(crossings[k].utime, crossings[k + 1].utime),
                       crest - trough, crest, trough,
                       stated(heave_sigma_m, top) + stated(heave_sigma_m, bottom)});
    }
    begin = std::max(end, begin + 1);
  }
  return waves;
}

namespace {

// Mean of `value` over the first `count` waves, the last of them with the fraction that is left.
template <class Value>
double leading_mean(std::span<const CountedWave> sorted, double count, Value value) {
  double sum = 0, left = count;
  for (std::size_t i = 0; i < sorted.size() && left > 0; ++i, left -= 1)
    sum += std::min(left, 1.0) * value(sorted[i]);
  return sum / count;
}

}  // namespace

std::vector<estimator::Wave> waves_of(std::span<const CountedWave> counted) {
  std::vector<estimator::Wave> waves;
  for (const CountedWave& c : counted) {
    estimator::Wave wave;
    wave.start_utime = c.start_utime;
    wave.seq = static_cast<std::int64_t>(waves.size());
    wave.period_s = c.period_s;
    wave.height_m = c.height_m;
    wave.calibration_sigma_m = c.sigma_m;
    waves.push_back(wave);
  }
  return waves;
}

WaveStatistics statistics_of(std::span<const CountedWave> waves) {
  WaveStatistics s;
  s.waves = static_cast<std::int64_t>(waves.size());
  if (waves.empty()) return s;
  std::vector<CountedWave> sorted(waves.begin(), waves.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const CountedWave& a, const CountedWave& b) { return a.height_m > b.height_m; });
  const auto height = [](const CountedWave& w) { return w.height_m; };
  const auto period = [](const CountedWave& w) { return w.period_s; };
  const auto n = static_cast<double>(waves.size());
  s.hmax_m = sorted.front().height_m;
  s.h110_m = leading_mean(sorted, n / 10, height);
  s.h13_m = leading_mean(sorted, n / 3, height);
  s.t13_s = leading_mean(sorted, n / 3, period);
  s.mean_height_m = leading_mean(sorted, n, height);
  s.mean_period_s = leading_mean(sorted, n, period);
  if (waves.size() > 1) {
    double squares = 0;
    for (const CountedWave& w : waves)
      squares += (w.height_m - s.mean_height_m) * (w.height_m - s.mean_height_m);
    s.std_height_m = std::sqrt(squares / (n - 1));
  }
  return s;
}

}  // namespace waverig::evaluation
