#include "estimator/heave/rests.h"

#include <algorithm>
#include <cmath>

namespace waverig::estimator {
namespace {

// Variance of the speed about its line at rest, over what the sensor's noise gives it; that speed of a body
// that moves as the sea does, over the sea's.
constexpr double kNoise = 4, kMoves = 0.7;
constexpr double kBetween_periods = 3;  // at most: what comes up more slowly is a sea all the time

}  // namespace

Rests find_rests(const Eigen::VectorXd& speed_mps, double interval_s, const Pace& sea,
                 double accel_noise_m2ps3) {
  const Eigen::Index nodes = speed_mps.size();
  const Eigen::Index half = std::max(std::lround(sea.period_s / 2 / interval_s), 2L), window = 2 * half + 1;
  const auto at = [](Eigen::Index k) { return static_cast<std::size_t>(k); };
  Rests rests{std::vector<bool>(at(nodes)), std::vector<bool>(at(nodes))};

  // Variance about the line of least squares, over a period about each node. Of a random walk it is 1/15 of
  // what that gains over the window.
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(window, -1, 1);
  const double noise_m2ps2 = accel_noise_m2ps3 * interval_s * static_cast<double>(window - 1) / 15;
  const double still_m2ps2 = std::pow(kStillRate * sea.rate_mps, 2) + kNoise * noise_m2ps2;
  const double moves_m2ps2 = std::pow(kMoves * sea.rate_mps, 2);
  Eigen::ArrayXd variance = Eigen::ArrayXd::Constant(nodes, moves_m2ps2);
  for (Eigen::Index first = 0; first + window <= nodes; ++first) {
    const auto speed = speed_mps.segment(first, window);
    const double mean = speed.mean(), slope = x.dot(speed) / x.squaredNorm();
    variance[first + half] =
        (speed.squaredNorm() - slope * slope * x.squaredNorm()) / static_cast<double>(window) - mean * mean;
  }

  if (nodes >= window) {
    variance.head(half) = variance[half];
    variance.tail(half) = variance[nodes - 1 - half];
  }

  for (Eigen::Index begin = 0; begin < nodes; ++begin) {
    Eigen::Index end = begin;
    while (end < nodes && variance[end] < still_m2ps2) ++end;
    if (end - begin >= half) std::fill(rests.still.begin() + begin, rests.still.begin() + end, true);
    begin = end;
  }
  Eigen::Index left = 0;  // nodes that are still to be taken as between
  const auto go_on = [&](Eigen::Index k) {
    if (rests.still[at(k)]) {
      left = std::lround(kBetween_periods * sea.period_s / interval_s);
    } else if (left > 0) {
      rests.between[at(k)] = true;
      if (variance[k] >= moves_m2ps2) left = std::min(left, half);
      --left;
    }
  };
  for (Eigen::Index k = 0; k < nodes; ++k) go_on(k);
  left = 0;
  for (Eigen::Index k = nodes - 1; k >= 0; --k) go_on(k);
  return rests;
}

}  // namespace waverig::estimator
