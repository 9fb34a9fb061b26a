// Cholesky factorisation of a banded symmetric positive-definite matrix, and the diagonal of its inverse.
#pragma once
#include <Eigen/Core>

namespace waverig::estimator {

class BandedCholesky {
 public:
  // size x size, with `band` sub-diagonals; zero at first.
  BandedCholesky(Eigen::Index size, Eigen::Index band) : band_(band), rows_(RowMajor::Zero(size, band + 1)) {}

  // Entry (i, j), i - band <= j <= i, of the lower triangle.
  double& at(Eigen::Index i, Eigen::Index j) { return rows_(i, j - i + band_); }

  // In place, L L' = A. False where A is not positive definite.
  bool factorise();
  void solve(Eigen::VectorXd& x) const;      // x := A^-1 x
  Eigen::VectorXd inverse_diagonal() const;  // Takahashi, Fagan, Chen 1973
  double log_determinant() const { return 2 * rows_.col(band_).array().log().sum(); }

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  double get(Eigen::Index i, Eigen::Index j) const { return rows_(i, j - i + band_); }
  Eigen::Index size() const { return rows_.rows(); }
  Eigen::Index band_;
  RowMajor rows_;  // row i holds columns i - band … i
};

}  // namespace waverig::estimator
