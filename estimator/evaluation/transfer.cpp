#include "estimator/evaluation/transfer.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace waverig::evaluation {
namespace {

using Complex = std::complex<double>;
constexpr int kLines = 2;             // on either side
constexpr double kSamplesACycle = 8;  // of the highest frequency, at least

struct Sums {
  Complex cross = 0;
  double truth = 0, error = 0;
};

void add_block(std::span<const double> heave_m, std::span<const double> true_heave_m, std::size_t stride,
               double cycles, Sums& sums) {
  const auto n = static_cast<double>(heave_m.size());
  Complex e = 0, t = 0;
  const double step = 2 * std::numbers::pi * static_cast<double>(stride) / n;
  Complex turn = 1, window = 1;
  const Complex next_turn = std::polar(1.0, -step * cycles), next_window = std::polar(1.0, step);
  for (std::size_t i = 0; i < heave_m.size(); i += stride) {
    const Complex weight = (1 - window.real()) * turn;  // Hann
    e += weight * heave_m[i];
    t += weight * true_heave_m[i];
    turn *= next_turn;
    window *= next_window;
  }
  sums.cross += e * std::conj(t);
  sums.truth += std::norm(t);
  sums.error += std::norm(e - t);
}

}  // namespace

std::vector<TransferPoint> transfer(std::span<const double> heave_m, std::span<const double> true_heave_m,
                                    double rate_hz, std::span<const double> frequencies_hz,
                                    const TransferSettings& settings) {
  const std::size_t size = std::min(heave_m.size(), true_heave_m.size());
  const auto block = static_cast<std::size_t>(settings.block_s * rate_hz);
  std::vector<TransferPoint> points;
  for (const double f_hz : frequencies_hz) {
    const auto stride =
        static_cast<std::size_t>(std::max(1.0, rate_hz / (kSamplesACycle * std::max(f_hz, 1.0))));
    Sums sums;
    for (std::size_t begin = 0; block > 0 && begin + block <= size; begin += (block + 1) / 2)
      for (int line = -kLines; line <= kLines; ++line)
        add_block(heave_m.subspan(begin, block), true_heave_m.subspan(begin, block), stride,
                  std::round(f_hz * settings.block_s) + line, sums);
    TransferPoint point{.f_hz = f_hz};
    if (sums.truth > 0) {
      point.gain = std::abs(sums.cross) / sums.truth;
      point.lag_s = -std::arg(sums.cross) / (2 * std::numbers::pi * f_hz);
      point.error_ratio = std::sqrt(sums.error / sums.truth);
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace waverig::evaluation
