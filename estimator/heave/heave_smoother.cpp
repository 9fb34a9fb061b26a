#include "estimator/heave/heave_smoother.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimator/heave/banded_cholesky.h"

namespace waverig::estimator {
namespace {

constexpr double kBiasVariance_m2ps4 = 0.1;  // nothing known
constexpr double kPathVariance_m2 = 1e4, kSpeedVariance_m2ps2 = 1e2;

// Path and speed at the nodes from rest, less the parabola of least squares: keeps the unknown drift small.
struct Path {
  Eigen::VectorXd path_m, speed_mps;
};

Path integrate(std::span<const PathIncrement> increments, double dt) {
  const auto n = static_cast<Eigen::Index>(increments.size()) + 1;
  Path p{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const PathIncrement& step = increments[static_cast<std::size_t>(k)];
    p.path_m[k + 1] = p.path_m[k] + dt * p.speed_mps[k] + step.path_m;
    p.speed_mps[k + 1] = p.speed_mps[k] + step.speed_mps;
  }
  // Legendre's polynomials on [-1, 1], orthogonal up to O(1/n): twice over is enough.
  const Eigen::VectorXd x =
      n > 1 ? Eigen::VectorXd(Eigen::VectorXd::LinSpaced(n, -1, 1)) : Eigen::VectorXd::Zero(1);
  const double per_s = n > 1 ? 2 / (dt * static_cast<double>(n - 1)) : 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    const double c0 = p.path_m.mean();
    p.path_m.array() -= c0;
    if (n < 4) break;
    const double c1 = p.path_m.dot(x) / x.squaredNorm();
    p.path_m -= c1 * x;
    p.speed_mps.array() -= c1 * per_s;
    const Eigen::VectorXd parabola = (1.5 * x.array().square() - 0.5).matrix();
    const double c2 = p.path_m.dot(parabola) / parabola.squaredNorm();
    p.path_m -= c2 * parabola;
    p.speed_mps -= 3 * c2 * per_s * x;
  }
  return p;
}

// Adds weight * r r' to the matrix and weight * r * value to the right side, for a residual r . u - value.
void add_row(BandedCholesky& A, Eigen::VectorXd& right, std::span<const Eigen::Index> index,
             std::span<const double> r, double value, double weight) {
  for (std::size_t i = 0; i < index.size(); ++i) {
    right[index[i]] += weight * r[i] * value;
    for (std::size_t j = 0; j < index.size(); ++j)
      if (index[j] <= index[i]) A.at(index[i], index[j]) += weight * r[i] * r[j];
  }
}

Eigen::Matrix3d drift_information(double noise_m2ps3, double walk_m2ps5, double dt) {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q(0, 0) = noise_m2ps3 * dt * dt * dt / 3;
  Q(0, 1) = Q(1, 0) = noise_m2ps3 * dt * dt / 2;
  Q(1, 1) = noise_m2ps3 * dt;
  Q(2, 2) = walk_m2ps5 * dt;
  return Q.inverse();
}

// u(k+1) - F u(k), six entries: G = [-F I].
Eigen::Matrix<double, 3, 6> drift_step(double dt) {
  Eigen::Matrix<double, 3, 6> G = Eigen::Matrix<double, 3, 6>::Zero();
  G.leftCols<3>() << -1, -dt, -dt * dt / 2, 0, -1, -dt, 0, 0, -1;
  G.rightCols<3>().setIdentity();
  return G;
}

}  // namespace

std::vector<SmoothedNode> smooth_heave(std::span<const PathIncrement> increments, const SeaModel& model,
                                       std::span<const double> disturbance_m2ps3) {
  const auto nodes = static_cast<Eigen::Index>(increments.size()) + 1;
  const double dt = model.interval_s;
  const Path path = integrate(increments, dt);
  const Predictors<1> predictors = levinson(model.autocovariance_m2);
  const Eigen::Index order = model.order();
  BandedCholesky A(3 * nodes, std::max<Eigen::Index>(3 * std::min(order, nodes - 1), 5));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * nodes);

  // The sea's innovations: e(k) = (path - d)(k) - sum a_j (path - d)(k-j).
  std::vector<Eigen::Index> index;
  std::vector<double> row;
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const Eigen::Index m = std::min(k, order);
    const Eigen::RowVectorXd& a = predictors.coefficients[static_cast<std::size_t>(m)];
    index.assign(1, 3 * k);
    row.assign(1, 1.0);
    double value = path.path_m[k];
    for (Eigen::Index j = 1; j <= m; ++j) {
      index.push_back(3 * (k - j));
      row.push_back(-a[j - 1]);
      value -= a[j - 1] * path.path_m[k - j];
    }
    add_row(A, u, index, row, value, 1 / predictors.variance[static_cast<std::size_t>(m)].value());
  }
  // The drift's steps.
  const Eigen::Matrix<double, 3, 6> G = drift_step(dt);
  for (Eigen::Index k = 0; k + 1 < nodes; ++k) {
    const double disturbance =
        disturbance_m2ps3.empty() ? 0.0 : disturbance_m2ps3[static_cast<std::size_t>(k)];
    const Eigen::Matrix<double, 6, 6> W =
        G.transpose() *
        drift_information(std::max(model.accel_noise_m2ps3, disturbance), model.bias_walk_m2ps5, dt) * G;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) A.at(3 * k + i, 3 * k + j) += W(i, j);
  }
  for (Eigen::Index k = 0; k < nodes; ++k)
    A.at(3 * k, 3 * k) += 1 / (kPathVariance_m2 * static_cast<double>(nodes));
  A.at(1, 1) += 1 / kSpeedVariance_m2ps2;
  A.at(2, 2) += 1 / kBiasVariance_m2ps4;

  if (!A.factorise()) throw std::logic_error("smooth_heave: the normal equations are not positive definite");
  A.solve(u);
  const Eigen::VectorXd variance = A.inverse_diagonal();
  std::vector<SmoothedNode> answer(static_cast<std::size_t>(nodes));
  for (Eigen::Index k = 0; k < nodes; ++k)
    answer[static_cast<std::size_t>(k)] = {path.path_m[k] - u[3 * k], path.speed_mps[k] - u[3 * k + 1],
                                           u[3 * k + 2], std::max(variance[3 * k], 0.0)};
  return answer;
}

}  // namespace waverig::estimator
