#include "estimator/heave/offset_changes.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig::estimator {
namespace {

constexpr double kWindow_s = 60;
constexpr double kLeast_mps2 = 2.5e-3 * kStandardGravity;
// Times the lower quartile, six standard deviations: of a body that leans over an offset changes all the
// time.
constexpr double kOutstanding = 19;
constexpr int kMost = 8;             // a sensor that does it more often is not to be mended
constexpr double kIndependent = 16;  // speeds in two windows: half waves of a sea as long as 15 s

// Hann's: of a sea nothing is left in a mean so weighted.
Eigen::VectorXd taper(Eigen::Index n) {
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5);
  return (1 - (2 * std::numbers::pi / static_cast<double>(n) * x).cos()) / static_cast<double>(n);
}

// By how much the mean acceleration changes at each node from the window-th on to the last but so many: over
// less than a window the sea does not average out.
Eigen::VectorXd changes_of_mean(const Eigen::VectorXd& a, Eigen::Index window) {
  const Eigen::Index n = a.size();
  const Eigen::VectorXd weight = taper(window);
  Eigen::VectorXd change(n - 2 * window + 1);
  for (Eigen::Index k = 0; k < change.size(); ++k)
    change[k] = weight.dot(a.segment(k + window, window) - a.segment(k, window));
  return change;
}

struct Corner {
  double squares, change;
};

// Least squares of c0 + c1 (k - at) + change max(0, k - at).
Corner corner(const Eigen::VectorXd& speed, Eigen::Index at) {
  const Eigen::Index n = speed.size();
  Eigen::MatrixX3d X(n, 3);
  X.col(0).setOnes();
  X.col(1).setLinSpaced(n, static_cast<double>(-at), static_cast<double>(n - 1 - at));
  X.col(2) = X.col(1).cwiseMax(0.0);
  const Eigen::Vector3d c = (X.transpose() * X).ldlt().solve(X.transpose() * speed);
  return {(speed - X * c).squaredNorm(), c[2]};
}

}  // namespace

std::vector<OffsetChange> find_offset_changes(std::span<const LevelIncrement> increments,
                                              std::int64_t first_utime, double dt) {
  const auto n = static_cast<Eigen::Index>(increments.size());
  const Eigen::Index window = std::lround(kWindow_s / dt);
  std::vector<OffsetChange> found;
  if (n < 2 * window) return found;
  Eigen::VectorXd a(n);
  for (Eigen::Index k = 0; k < n; ++k) a[k] = increments[static_cast<std::size_t>(k)].speed_mps[0] / dt;
  while (std::ssize(found) < kMost) {
    Eigen::VectorXd size = changes_of_mean(a, window).cwiseAbs();
    Eigen::Index peak = 0;
    const double largest = size.maxCoeff(&peak);
    peak += window;
    const auto usual = size.begin() + size.size() / 4;
    std::nth_element(size.begin(), usual, size.end());
    if (largest < std::max(kLeast_mps2, kOutstanding * *usual)) break;

    const Eigen::Index from = peak - window, to = peak + window;
    Eigen::VectorXd speed = Eigen::VectorXd::Zero(to - from + 1);
    for (Eigen::Index k = from; k < to; ++k) speed[k - from + 1] = speed[k - from] + dt * a[k];
    Eigen::Index at = window;
    Corner best = corner(speed, at);
    for (Eigen::Index k = window / 2; k < speed.size() - window / 2; ++k)
      if (const Corner c = corner(speed, k); c.squares < best.squares) {
        best = c;
        at = k;
      }
    const double mps2 = best.change / dt,
                 noise_mps = std::sqrt(best.squares / static_cast<double>(speed.size()));
    found.push_back({first_utime + std::llround(static_cast<double>(from + at) * dt / kMicrosecond), mps2,
                     std::hypot(noise_mps / std::abs(mps2) / std::sqrt(kIndependent), dt / std::sqrt(12))});
    a.tail(n - from - at).array() -= mps2;
  }
  std::sort(found.begin(), found.end(),
            [](const OffsetChange& x, const OffsetChange& y) { return x.utime < y.utime; });
  return found;
}

}  // namespace waverig::estimator
