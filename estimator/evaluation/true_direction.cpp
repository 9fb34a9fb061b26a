#include "estimator/evaluation/true_direction.h"

#include <cmath>
#include <numbers>

#include "estimator/compass/cross_spectra.h"

namespace waverig::evaluation {
namespace {

constexpr double kStep_s = 0.2, kShortest_s = 20, kRise_s = 20;
constexpr double kLowest_Hz = 0.03, kHighest_Hz = 1;

}  // namespace

TrueDirection true_direction(const TruthSeries& truth, std::int64_t begin_utime, std::int64_t end_utime) {
  const double duration_s = static_cast<double>(end_utime - begin_utime) * kMicrosecond;
  if (truth.empty() || !(duration_s >= kShortest_s)) return {};
  const auto n = static_cast<std::size_t>(duration_s / kStep_s);
  std::vector<double> up(n), north(n), east(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto utime = begin_utime + std::llround((static_cast<double>(i) + 0.5) * kStep_s / kMicrosecond);
    const TruthSeries::Point heave = truth.at(utime);
    const Eigen::Vector2d horizontal_m = truth.horizontal_m(utime);
    up[i] = heave.heave_m;
    north[i] = horizontal_m.x();
    east[i] = horizontal_m.y();
    if (!std::isfinite(up[i]) || !horizontal_m.allFinite()) return {};
  }
  std::vector<double> window(n, 1.0);
  estimator::soften_ends(window, std::min(static_cast<std::size_t>(kRise_s / kStep_s), n / 4));
  estimator::CrossSpectra spectra(n, kStep_s);
  spectra.add(std::move(up), std::move(north), std::move(east), window);

  double z = 0, h = 0, to_north = 0, to_east = 0;  // as in directional.h
  for (std::size_t k = 0; k < spectra.frequencies(); ++k) {
    const double f_Hz = static_cast<double>(k) * spectra.step_Hz();
    if (f_Hz < kLowest_Hz || f_Hz > kHighest_Hz) continue;
    z += spectra.zz[k];
    h += spectra.nn[k] + spectra.ee[k];
    to_north += std::imag(spectra.zn[k]);
    to_east += std::imag(spectra.ze[k]);
  }
  if (!(z > 0 && h > 0)) return {};
  const double direction_rad = std::atan2(to_east, to_north);
  const double first = std::hypot(to_north, to_east) / std::sqrt(z * h);
  return {direction_rad < 0 ? direction_rad + 2 * std::numbers::pi : direction_rad,
          std::sqrt(2 * std::max(0.0, 1 - first)), std::sqrt(h / z)};
}

}  // namespace waverig::evaluation
