// SeaModel: the stochastic model of heave and of what disturbs its measurement, on an even grid of nodes.
//
// Heave at the nodes is an autoregression, the maximum-entropy process of a given autocovariance (Burg 1975):
//     z(k) = sum_j a_j z(k-j) + e(k),        e white
// and its double-integrated acceleration reads z(k) + d(k), where the drift d obeys
//     d'' = b + n_a,   b' = n_b              (n_a: acceleration noise, b: slow bias, n_b: its walk)
#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>

namespace waverig::estimator {

// Sea and noise are seen at nodes this far apart; a model's own nodes may lie wider.
inline constexpr double kFineInterval_s = 0.25;

struct SeaModel {
  double interval_s = 0.5;            // between nodes
  Eigen::VectorXd autocovariance_m2;  // of heave at the nodes, lags 0 … order
  Eigen::VectorXd ar;                 // a_1 … a_order
  double innovation_m2 = 0;           // variance of e
  double accel_noise_m2ps3 = 0;       // two-sided density of n_a, m^2/s^3
  double bias_walk_m2ps5 = 0;         // two-sided density of n_b
  double mean_frequency_radps = 0;    // sqrt(m2/m0) of heave

  void set_noise(double accel_noise_m2ps3);  // and the walk that goes with it
  int order() const { return static_cast<int>(ar.size()); }
  double heave_variance_m2() const { return autocovariance_m2[0]; }
  double acceleration_mps2() const;  // of heave, root mean square: its second difference at the nodes
};

// One-step predictors of every order 0 … n of stationary processes, a row each (Levinson 1947, Durbin 1960).
template <int Rows>
struct Predictors {
  std::vector<Eigen::Matrix<double, Rows, Eigen::Dynamic>> coefficients;  // [m] has m columns
  std::vector<Eigen::Array<double, Rows, 1>> variance;                    // of their errors
};

// autocovariance: a column a lag, 0 … n.
template <int Rows>
Predictors<Rows> levinson(const Eigen::Matrix<double, Rows, Eigen::Dynamic>& autocovariance) {
  using Column = Eigen::Array<double, Rows, 1>;
  using Coefficients = Eigen::Matrix<double, Rows, Eigen::Dynamic>;
  const auto& r = autocovariance.array();
  Predictors<Rows> p{{Coefficients(r.rows(), 0)}, {r.col(0)}};
  for (Eigen::Index m = 1; m < r.cols(); ++m) {
    const Coefficients& a = p.coefficients.back();
    Column reflection = r.col(m);
    for (Eigen::Index j = 1; j < m; ++j) reflection -= a.col(j - 1).array() * r.col(m - j);
    reflection /= p.variance.back();
    Coefficients next(r.rows(), m);
    for (Eigen::Index j = 1; j < m; ++j)
      next.col(j - 1).array() = a.col(j - 1).array() - reflection * a.col(m - j - 1).array();
    next.col(m - 1) = reflection;
    p.coefficients.push_back(std::move(next));
    p.variance.push_back(p.variance.back() * (1 - reflection.square()));
  }
  return p;
}

// Of one process: its lags.
inline Predictors<1> levinson(const Eigen::VectorXd& autocovariance) {
  return levinson(Eigen::RowVectorXd(autocovariance));
}

// The model, with nodes interval_s apart, of a sea with the given density of heave (two-sided, m^2 s, at i *
// df_hz). ridge: of the variance, white: how far no frequency is ruled out.
SeaModel model_of_density(const Eigen::VectorXd& density, double df_hz, double interval_s, int order,
                          double ridge);

// The fine interval for a sea with much above half a hertz, twice as wide for all others: the order then
// reaches over some three periods. present_s: of the model that stands, which is kept in doubt.
double suited_interval_s(const Eigen::VectorXd& density, double df_hz, double present_s);

// A fully grown sea (Pierson, Moskowitz 1964): density of heave, two-sided, at i * df_hz for i < bins.
Eigen::VectorXd pierson_moskowitz_m2s(double variance_m2, double tp_s, Eigen::Index bins, double df_hz);

// Before anything is known: such a sea, with waves of up to 14 s, and of Hs 2 m.
inline constexpr double kUnknownSea_m2 = 0.25;  // its variance
Eigen::VectorXd unknown_sea_density_m2s(Eigen::Index bins, double df_hz);
SeaModel unknown_sea(double interval_s, int order, double accel_noise_m2ps3);

}  // namespace waverig::estimator
