#include "estimator/waves/wave_timing.h"

#include <algorithm>
#include <cmath>

namespace waverig::estimator {
namespace {

// Chi-square beyond which a line is refused: about three standard deviations above its mean.
double refused_above(double freedom) { return freedom + 3 * std::sqrt(2 * freedom) + 2; }

// Line (and, with curved, parabola) through n crossings from first on, numbered from the wave k.
struct Line {
  double slope = 0, slope_variance = 0, at_wave = 0, chi_square = 0, freedom = 0;
};

Line line_through(const std::vector<WaveEvent>& events, std::size_t first, std::size_t n, std::size_t k,
                  bool curved) {
  const double size = static_cast<double>(n);
  const double centre = static_cast<double>(first) + 0.5 * (size - 1);
  const double origin_s = events[k].down_crossing_s;  // keeps the sums small
  double y0 = 0, y1 = 0, y2 = 0, variance = 0;
  const double xx = size * (size * size - 1) / 12, q_mean = (size * size - 1) / 12;
  double qq = 0;
  for (std::size_t i = first; i < first + n; ++i) {
    const double x = static_cast<double>(i) - centre, y = events[i].down_crossing_s - origin_s,
                 q = x * x - q_mean;
    y0 += y, y1 += x * y, y2 += q * y, qq += q * q;
    variance += events[i].sigma_s * events[i].sigma_s;
  }
  variance /= size;
  Line line;
  line.slope = y1 / xx;
  line.slope_variance = variance / xx;
  const double curve = curved ? y2 / qq : 0, mean = y0 / size;
  for (std::size_t i = first; i < first + n; ++i) {
    const double x = static_cast<double>(i) - centre;
    const double r = events[i].down_crossing_s - origin_s - mean - line.slope * x - curve * (x * x - q_mean);
    line.chi_square += r * r / variance;
  }
  line.freedom = size - (curved ? 3 : 2);
  const double xk = static_cast<double>(k) - centre;
  line.at_wave = origin_s + mean + line.slope * xk + curve * (xk * xk - q_mean);
  return line;
}

}  // namespace

std::vector<WaveTiming> share_frequency(const std::vector<WaveEvent>& events) {
  std::vector<WaveTiming> timings(events.size());
  std::size_t run_begin = 0;
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (!events[k].follows) run_begin = k;
    std::size_t run_end = k + 1;
    while (run_end < events.size() && run_end < k + kMostSharedWaves && events[run_end].follows) ++run_end;
    const std::size_t low = std::max(run_begin, k + 1 >= kMostSharedWaves ? k + 1 - kMostSharedWaves : 0);
    WaveTiming& timing = timings[k];
    timing.down_crossing_s = events[k].down_crossing_s;
    timing.waves = 1;
    for (std::size_t n = std::min(kMostSharedWaves, run_end - low); n >= 2 && timing.waves == 1; --n) {
      // All spans of n waves that hold wave k, the most central first.
      const auto ideal = static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(n - 1) / 2;
      for (std::ptrdiff_t off = 0; off < static_cast<std::ptrdiff_t>(n) && timing.waves == 1; ++off) {
        for (const std::ptrdiff_t side : {off, -off}) {
          const std::ptrdiff_t first = ideal + side;
          const auto last = first + static_cast<std::ptrdiff_t>(n);
          if (first < static_cast<std::ptrdiff_t>(low) || last > static_cast<std::ptrdiff_t>(run_end))
            continue;
          if (first > static_cast<std::ptrdiff_t>(k) || last <= static_cast<std::ptrdiff_t>(k)) continue;
          const bool central = n % 2 == 1 && side == 0 && n >= 5;
          const Line line = line_through(events, static_cast<std::size_t>(first), n, k, central);
          if (line.chi_square > refused_above(line.freedom)) continue;
          timing.period_s = line.slope;
          timing.sigma_s = std::sqrt(line.slope_variance);
          timing.down_crossing_s = line.at_wave;
          timing.waves = n;
          break;
        }
      }
    }
  }
  return timings;
}

}  // namespace waverig::estimator
