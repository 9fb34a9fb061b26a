#include "estimator/heave/banded_cholesky.h"

#include <algorithm>
#include <cmath>

namespace waverig::estimator {

bool BandedCholesky::factorise() {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Eigen::Index first = std::max<Eigen::Index>(0, i - band_);
    for (Eigen::Index j = first; j <= i; ++j) {
      const Eigen::Index from = std::max(first, j - band_), count = j - from;
      const double sum =
          get(i, j) -
          rows_.row(i).segment(from - i + band_, count).dot(rows_.row(j).segment(from - j + band_, count));
      if (j < i) {
        at(i, j) = sum / get(j, j);
      } else {
        if (!(sum > 0)) return false;
        at(i, i) = std::sqrt(sum);
      }
    }
  }
  return true;
}

void BandedCholesky::solve(Eigen::VectorXd& x) const {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const Eigen::Index first = std::max<Eigen::Index>(0, i - band_), count = i - first;
    x[i] = (x[i] - rows_.row(i).segment(first - i + band_, count).dot(x.segment(first, count))) / get(i, i);
  }
  for (Eigen::Index i = size(); i-- > 0;) {
    const Eigen::Index first = std::max<Eigen::Index>(0, i - band_), count = i - first;
    x[i] /= get(i, i);
    x.segment(first, count) -= x[i] * rows_.row(i).segment(first - i + band_, count).transpose();
  }
}

// Z = A^-1 within the band, from the last row up: Z L = L^-T, whose lower triangle is diag(1 / L_jj), gives
//     Z_ij = (delta_ij / L_jj - sum_{k > j} Z_ik L_kj) / L_jj,      i >= j.
// The window holds Z for the columns j … j + band, as a ring.
Eigen::VectorXd BandedCholesky::inverse_diagonal() const {
  const Eigen::Index n = size(), w = band_ + 1;
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(w, w);  // Z(i mod w, k mod w)
  Eigen::VectorXd diagonal(n), column(w), row(w);
  for (Eigen::Index j = n; j-- > 0;) {
    const Eigen::Index last = std::min(n - 1, j + band_);
    column.setZero();  // L_kj, k = j + 1 … last, at k mod w
    for (Eigen::Index k = j + 1; k <= last; ++k) column[k % w] = get(k, j) / get(j, j);
    Z.row(j % w).setZero();
    Z.col(j % w).setZero();
    row.noalias() = -(Z * column);  // Z_ij for i > j; Z is symmetric
    row[j % w] = 0;
    const double jj = 1 / (get(j, j) * get(j, j)) - column.dot(row);
    row[j % w] = jj;
    Z.row(j % w) = row.transpose();
    Z.col(j % w) = row;
    diagonal[j] = jj;
  }
  return diagonal;
}

}  // namespace waverig::estimator
