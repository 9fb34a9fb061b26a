// The physical limit of heave in a sea: the least error that any linear estimator can have who knows the
// sea's spectrum and hears nothing but an accelerometer with white noise and a wandering bias (Wiener 1949).
// For a Gaussian sea it is the least of all. Tilt, the unknown offset and the learning of the spectrum come
// on top of it.
//
// On even nodes dt apart the accelerometer's double integral reads p = z + d, z heave, d noise integrated
// twice from an unknown path and speed. What is known is p's second difference
//   y(k) = p(k) - 2 p(k-1) + p(k-2),   D(w) = (1 - e^(-i w dt))^2,   q = nd^2 / 2 (two-sided),
//   Phi_yy = |D|^2 S / dt + q dt^3 (2 + cos w dt) / 3 + (2 sin(w dt / 2) / w)^4 Sb / dt,
//   Phi_zy = conj(D) S / dt
// with S the two-sided density of heave on the nodes (what lies above half their rate folded back) and
// Sb = 2 sb^2 tb / (1 + (w tb)^2) that of the bias, a first-order Gauss-Markov process. With
// Phi_yy = |B|^2, B causal and causally invertible (Kolmogorov 1941, by the cepstrum), the weights of heave
// on the unit innovations are g = F^-1 Phi_zy / conj(B), and
//   var(lag) = sum over n < -lag of g(n)^2 + integral of S Sn / (S + Sn),   Sn = Phi_dd / |D|^2,
// in which the integral, without causality, is all that is left where the lag is long.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "estimator/types.h"

namespace waverig::evaluation {

inline constexpr double kWholeRecord_s = std::numeric_limits<double>::infinity();  // as lag: no causality

struct HeaveBoundSettings {
  std::function<double(double f_hz)> density_m2_per_hz;  // of heave, one-sided, f >= 0
  double noise_density_mps2_rthz = estimator::kUnknown;  // of the vertical acceleration, one-sided
  double interval_s = 0.25;  // of the nodes; below a fortieth of the peak period little changes
  double instability_sigma_mps2 = 0, instability_time_s = 100;  // sb and tb
};

class HeaveBound {
 public:
  // Everything is unknown (NaN) where the noise is not positive.
  explicit HeaveBound(const HeaveBoundSettings& settings);

  // lag_s >= 0, 0 <= from_s <= duration_s.
  double heave_std_m() const;  // of the sea itself
  // Standard deviation of the error in the midst of an endless record, lag_s (to the nearest node) behind the
  // newest sample.
  double steady_m(double lag_s) const;
  // RMS over [from_s, duration_s] of a record that begins and ends in the midst of the sea: at its begin
  // nothing is known of path and speed, at its end no later sample is waited for. The record is taken to be
  // longer than the memory of the two ends together, a minute or two.
  double record_m(double lag_s, double duration_s, double from_s = 0) const;

 private:
  std::ptrdiff_t nodes_of(double lag_s) const;
  double variance_m2(std::ptrdiff_t lag) const;
  std::vector<double> begin_excess_m2(std::ptrdiff_t lag) const;

  double interval_s_;
  std::vector<double> heave_y_m2_;  // covariance of z(k) and y(k-n), n cyclic
  std::vector<double> lagged_m2_;   // var(lag), in nodes
  Eigen::MatrixXd y_factor_;        // of the covariance of the first y, lower triangle
  double heave_m2_ = estimator::kUnknown, whole_m2_ = estimator::kUnknown;
};

}  // namespace waverig::evaluation
