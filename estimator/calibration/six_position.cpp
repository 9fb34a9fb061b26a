#include "estimator/calibration/six_position.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kRows =
    18;  // of the design matrix; its 12 or 15 columns: M row by row, b, and where the model has it q

constexpr int kBendIterations = 4;  // each gains the factor q g, some 1e-3

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Rows of one position: reading_i = M_i1 f_1 + M_i2 f_2 + M_i3 f_3 + b_i + q_i u_i^2.
void fill_rows(MatrixXd& A, int position, const Vector3d& f_B, const Vector3d& u) {
  for (int i = 0; i < 3; ++i) {
    const int row = 3 * position + i;
    A.row(row).setZero();
    A.block<1, 3>(row, 3 * i) = f_B.transpose();
    A(row, 9 + i) = 1;
    if (A.cols() > 12) A(row, 12 + i) = u[i] * u[i];
  }
}

AccelerometerCalibration calibration_of(const VectorXd& x) {
  AccelerometerCalibration c;
  c.M = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(x.data());
  c.b_mps2 = x.segment<3>(9);
  if (x.size() > 12) c.quadratic_pmps2 = x.tail<3>();
  return c;
}

// Sum of squares of the residuals in units of their uncertainty, over the directions that the fit leaves
// free.
double chi_square_of(const VectorXd& residual, const MatrixXd& readings_covariance, const MatrixXd& remover,
                     int unknowns) {
  const MatrixXd covariance = remover * readings_covariance * remover.transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(covariance);
  double sum = 0;
  for (int i = unknowns; i < kRows; ++i) {  // ascending: the last ones are not zero by construction
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

SixPositionFit fit_six_positions(const std::array<PositionReading, 6>& readings, double fixture_sigma_rad,
                                 SixPositionModel model) {
  const bool bent = model == SixPositionModel::kBent;
  MatrixXd A(kRows, bent ? 15 : 12);
  VectorXd y(kRows), x;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  SixPositionFit fit;
  for (int iteration = 0; iteration < (bent ? kBendIterations : 1); ++iteration) {
    for (int k = 0; k < 6; ++k) {
      const PositionReading& reading = readings[static_cast<std::size_t>(k)];
      const Vector3d u = iteration == 0 ? reading.mean_mps2
                                        : Vector3d(fit.calibration.M * reading.f_B + fit.calibration.b_mps2);
      fill_rows(A, k, reading.f_B, u);
      y.segment<3>(3 * k) = reading.mean_mps2;
    }
    decomposition.compute(A);
    if (!y.allFinite() || decomposition.rank() < A.cols())
      throw UserError("six-position calibration: positions: expected each axis once up and once down");
    x = decomposition.solve(y);
    fit.calibration = calibration_of(x);
  }

  // What the readings are worth: scatter, and the fixture's miss d, which moves f by f x d.
  MatrixXd S = MatrixXd::Zero(kRows, kRows);
  for (int k = 0; k < 6; ++k) {
    const PositionReading& reading = readings[static_cast<std::size_t>(k)];
    const Matrix3d J = fit.calibration.M * cross(reading.f_B) * fixture_sigma_rad;
    S.block<3, 3>(3 * k, 3 * k) = reading.covariance + J * J.transpose();
  }
  const int n = static_cast<int>(A.cols());
  const MatrixXd solver = decomposition.pseudoInverse();
  fit.calibration.covariance.topLeftCorner(n, n) = solver * S * solver.transpose();

  const VectorXd residual = y - A * x;
  for (int k = 0; k < 6; ++k) fit.residual_mps2[static_cast<std::size_t>(k)] = residual.segment<3>(3 * k);
  fit.residual_rms_mps2 = std::sqrt(residual.squaredNorm() / kRows);
  fit.degrees_of_freedom = kRows - n;
  fit.chi_square = chi_square_of(residual, S, MatrixXd::Identity(kRows, kRows) - A * solver, n);
  return fit;
}

CalibrationError error_against(const AccelerometerCalibration& found, const AccelerometerCalibration& truth) {
  const auto unknowns_of = [](const AccelerometerCalibration& c) {
    Eigen::Matrix<double, 15, 1> x;
    x << c.M.row(0).transpose(), c.M.row(1).transpose(), c.M.row(2).transpose(), c.b_mps2, c.quadratic_pmps2;
    return x;
  };
  const Eigen::Matrix<double, 15, 1> error = unknowns_of(found) - unknowns_of(truth);
  // Scaled to a unit diagonal, with 1 where nothing is stated: the unknowns differ in unit by orders of
  // magnitude.
  MatrixXd scaled = MatrixXd::Identity(15, 15);
  CalibrationError result;
  for (int i = 0; i < 15; ++i) {
    if (!(found.covariance(i, i) > 0)) continue;
    ++result.degrees_of_freedom;
    result.over_sigma[i] = error[i] / std::sqrt(found.covariance(i, i));
    for (int k = 0; k < 15; ++k)
      if (found.covariance(k, k) > 0)
        scaled(i, k) = found.covariance(i, k) / std::sqrt(found.covariance(i, i) * found.covariance(k, k));
  }
  result.chi_square = result.over_sigma.dot(Eigen::LDLT<MatrixXd>(scaled).solve(result.over_sigma));
  return result;
}

}  // namespace waverig::estimator
