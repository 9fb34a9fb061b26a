#include "estimator/calibration/allan.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace waverig::estimator {
namespace {

constexpr int kTerms = 4;
using Vector4 = Eigen::Matrix<double, kTerms, 1>;
using Matrix4 = Eigen::Matrix<double, kTerms, kTerms>;

Vector4 basis(double tau_s) {
  return {3 / (tau_s * tau_s), 1 / tau_s, 2 * std::numbers::ln2 / std::numbers::pi, tau_s / 3};
}

// Least squares over the terms in `used`; the others stay zero.
Vector4 solve(const Matrix4& normal, const Vector4& right, unsigned used) {
  Matrix4 m = Matrix4::Identity();
  Vector4 r = Vector4::Zero();
  for (int i = 0; i < kTerms; ++i) {
    if ((used >> i & 1U) == 0) continue;
    r[i] = right[i];
    for (int j = 0; j < kTerms; ++j)
      if ((used >> j & 1U) != 0) m(i, j) = normal(i, j);
  }
  // Scaled to a unit diagonal: the terms differ by many orders of magnitude.
  const Vector4 scale = m.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix4 scaled = scale.asDiagonal() * m * scale.asDiagonal();
  return scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(r)));
}

}  // namespace

std::vector<AllanPoint> allan_deviation(std::span<const double> record, double interval_s, int per_octave) {
  const std::size_t n = record.size();
  std::vector<double> sum(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + record[i];
  std::vector<AllanPoint> points;
  std::size_t previous = 0;
  for (int k = 0;; ++k) {
    const auto m = static_cast<std::size_t>(std::llround(std::exp2(static_cast<double>(k) / per_octave)));
    if (4 * m > n) break;
    if (m == previous) continue;
    previous = m;
    double square = 0;
    const std::size_t count = n - 2 * m + 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double difference = sum[i + 2 * m] - 2 * sum[i + m] + sum[i];
      square += difference * difference;
    }
    const double md = static_cast<double>(m);
    points.push_back({md * interval_s, std::sqrt(square / (2 * static_cast<double>(count))) / md,
                      static_cast<double>(n) / md - 1});
  }
  return points;
}

double AllanTerms::one_sided_density() const { return random_walk * std::numbers::sqrt2; }

AllanTerms fit_allan(std::span<const AllanPoint> points) {
  Matrix4 normal = Matrix4::Zero();
  Vector4 right = Vector4::Zero();
  for (const AllanPoint& p : points) {
    const double variance = p.deviation * p.deviation;
    if (!(variance > 0)) continue;
    const double weight =
        p.degrees / (2 * variance * variance);  // a variance's own variance: 2 s^4 / degrees
    const Vector4 b = basis(p.tau_s);
    normal += weight * b * b.transpose();
    right += weight * variance * b;
  }
  // Four terms, sixteen subsets: the best with no negative coefficient, found by trying them all.
  Vector4 best = Vector4::Zero();
  double best_gain = 0;
  const auto terms = points.size() < kTerms ? 0U : 1U << kTerms;
  for (unsigned used = 1; used < terms; ++used) {
    const Vector4 c = solve(normal, right, used);
    const double gain = 2 * c.dot(right) - c.dot(normal * c);  // how far the weighted squares fall
    if (c.minCoeff() < 0 || gain <= best_gain) continue;
    best_gain = gain;
    best = c;
  }
  const Vector4 root = best.cwiseSqrt();
  return {root[0], root[1], root[2], root[3]};
}

}  // namespace waverig::estimator
