#include "estimator/waves/wave_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace waverig::estimator {
namespace {

constexpr int kUnknowns = 5;
using Vector5 = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix5 = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr int kBlocks = 24;  // of the residual, per wave
constexpr double kLeastCoverage = 0.75;

// Columns cos, sin, cos 2, sin 2, 1, averaged over the bin.
Vector5 row_of(const Bin& bin, double tau_s, double w) {
  const double c = std::cos(w * tau_s), s = std::sin(w * tau_s);
  const double k1 = bin.attenuation(w), k2 = bin.attenuation(2 * w);
  return {k1 * c, k1 * s, k2 * (c * c - s * s), k2 * 2 * s * c, 1.0};
}

}  // namespace

WaveFit fit_wave(const WaveSeries& series, double begin_s, double end_s, double w, double slope_mps3) {
  WaveFit fit;
  fit.begin_s = begin_s;
  fit.end_s = end_s;
  fit.middle_s = 0.5 * (begin_s + end_s);
  fit.omega_radps = w;
  const BinRange range = range_of(series, begin_s, end_s);
  fit.coverage = static_cast<double>(range.size()) * series.bin_s() / (end_s - begin_s);
  if (range.size() < 2 * kUnknowns || fit.coverage < kLeastCoverage) return fit;

  const std::deque<Bin>& bins = series.bins();
  Matrix5 N = Matrix5::Zero();
  Vector5 y = Vector5::Zero();
  double count = 0;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const double tau = bins[i].t_s - fit.middle_s;
    const Vector5 row = row_of(bins[i], tau, w);
    N.noalias() += bins[i].count * row * row.transpose();
    y.noalias() += bins[i].count * (bins[i].up_mps2 - slope_mps3 * tau) * row;
    count += bins[i].count;
  }
  const Eigen::LDLT<Matrix5> solver(N);
  const Vector5 x = solver.solve(y);
  if (!x.allFinite()) return fit;
  fit.cos_mps2 = x(0);
  fit.sin_mps2 = x(1);
  fit.second_mps2 = std::hypot(x(2), x(3));
  fit.offset_mps2 = x(4);
  // White noise of one-sided density d has variance d^2 / (2 dt) per sample.
  const double dt_s = static_cast<double>(range.size()) * series.bin_s() / count;
  const double variance = 0.5 * (solver.solve(Vector5::Unit(0))(0) + solver.solve(Vector5::Unit(1))(1));
  fit.sigma_per_density = std::sqrt(0.5 * variance / dt_s);

  const std::size_t per_block = std::max<std::size_t>(1, range.size() / kBlocks);
  double squares = 0, blocks = 0;
  for (std::size_t i = range.first; i + per_block <= range.last; i += per_block) {
    double sum = 0, weight = 0;
    for (std::size_t j = i; j < i + per_block; ++j) {
      const double tau = bins[j].t_s - fit.middle_s;
      sum += bins[j].count * (bins[j].up_mps2 - slope_mps3 * tau - row_of(bins[j], tau, w).dot(x));
      weight += bins[j].count;
    }
    squares += sum * sum / (weight * weight);
    blocks += 1;
  }
  const double block_variance = squares / std::max(1.0, blocks - kUnknowns);
  fit.misfit_mps2 = std::sqrt(block_variance);
  fit.noise_density = std::sqrt(2 * block_variance * static_cast<double>(per_block) * series.bin_s());
  fit.valid = true;
  return fit;
}

}  // namespace waverig::estimator
