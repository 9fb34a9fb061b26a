#include "estimator/calibration/six_position.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Matrix18d = Eigen::Matrix<double, 18, 18>;
using Design = Eigen::Matrix<double, 18, 12>;
using Vector18d = Eigen::Matrix<double, 18, 1>;

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Rows of one position: reading_i = M_i1 f_1 + M_i2 f_2 + M_i3 f_3 + b_i.
Eigen::Matrix<double, 3, 12> design_rows(const Vector3d& f_B) {
  Eigen::Matrix<double, 3, 12> rows = Eigen::Matrix<double, 3, 12>::Zero();
  for (int i = 0; i < 3; ++i) {
    rows.block<1, 3>(i, 3 * i) = f_B.transpose();
    rows(i, 9 + i) = 1;
  }
  return rows;
}

// Sum of squares of the residuals in units of their uncertainty, over the 6 directions that the fit leaves free.
double chi_square_of(const Vector18d& residual, const Matrix18d& readings_covariance, const Matrix18d& remover) {
  const Matrix18d covariance = remover * readings_covariance * remover.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix18d> eigen(covariance);
  double sum = 0;
  for (int i = 12; i < 18; ++i) {   // ascending: the last six are not zero by construction
    const double variance = eigen.eigenvalues()[i];
    const double part = eigen.eigenvectors().col(i).dot(residual);
    if (variance > 0) sum += part * part / variance;
  }
  return sum;
}

}  // namespace

void PositionRecorder::add(const Vector3d& reading) {
  ++samples_;
  batch_sum_ += reading;
  if (++in_batch_ < samples_per_batch_) return;
  const Vector3d batch = batch_sum_ / static_cast<double>(in_batch_);
  batch_sum_.setZero();
  in_batch_ = 0;
  ++batches_;
  const Vector3d before = batch - mean_;
  mean_ += before / static_cast<double>(batches_);
  sum_of_squares_ += before * (batch - mean_).transpose();
}

Vector3d PositionRecorder::mean() const { return mean_; }

Matrix3d PositionRecorder::mean_covariance() const {
  if (batches_ < 2) return Matrix3d::Zero();
  const double n = static_cast<double>(batches_);
  // Batches are independent enough; the Student factor of few batches is left to the residuals' chi-square.
  const Matrix3d symmetric = 0.5 * (sum_of_squares_ + sum_of_squares_.transpose());
  return symmetric / (n * (n - 1));
}

SixPositionFit fit_six_positions(const std::array<PositionReading, 6>& readings, double fixture_sigma_rad) {
  Design A;
  Vector18d y;
  for (int k = 0; k < 6; ++k) {
    const PositionReading& reading = readings[static_cast<std::size_t>(k)];
    A.block<3, 12>(3 * k, 0) = design_rows(reading.f_B);
    y.segment<3>(3 * k) = reading.mean_mps2;
  }
  Eigen::ColPivHouseholderQR<Design> qr(A);
  if (!y.allFinite() || qr.rank() < 12)
    throw UserError("six-position calibration: positions: expected each axis once up and once down");
  const Eigen::Matrix<double, 12, 1> x = qr.solve(y);

  SixPositionFit fit;
  fit.calibration.M = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(x.data());
  fit.calibration.b_mps2 = x.tail<3>();

  // What the readings are worth: scatter, and the fixture's miss d, which moves f by f x d.
  Matrix18d S = Matrix18d::Zero();
  for (int k = 0; k < 6; ++k) {
    const PositionReading& reading = readings[static_cast<std::size_t>(k)];
    const Matrix3d J = fit.calibration.M * cross(reading.f_B) * fixture_sigma_rad;
    S.block<3, 3>(3 * k, 3 * k) = reading.covariance + J * J.transpose();
  }
  const Eigen::Matrix<double, 12, 18> solver = (A.transpose() * A).inverse() * A.transpose();
  fit.calibration.covariance = solver * S * solver.transpose();

  const Vector18d residual = y - A * x;
  for (int k = 0; k < 6; ++k) fit.residual_mps2[static_cast<std::size_t>(k)] = residual.segment<3>(3 * k);
  fit.residual_rms_mps2 = std::sqrt(residual.squaredNorm() / 18);
  fit.chi_square = chi_square_of(residual, S, Matrix18d::Identity() - A * solver);
  return fit;
}

}  // namespace waverig::estimator
