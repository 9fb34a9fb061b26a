#include "estimator/heave/sea_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig::estimator {
namespace {

constexpr double kBiasCorner_radps = 0.035;  // below it the bias walk outweighs the noise: somewhat less than
                                             // the data sheet's, whose 0.1 mg in 100 s need 0.05
constexpr double kFast_hz = 0.5;             // half of what nodes half a second apart can tell
constexpr double kFastShare = 0.02;          // of the sea's variance above it: needs the fine nodes
constexpr double kUnknownPeak_s = 14;
constexpr double kUnknownRidge = 1e-5;

}  // namespace

void SeaModel::set_noise(double density_m2ps3) {
  accel_noise_m2ps3 = density_m2ps3;
  bias_walk_m2ps5 = density_m2ps3 * kBiasCorner_radps * kBiasCorner_radps;
}

double SeaModel::acceleration_mps2() const {
  const Eigen::VectorXd& r = autocovariance_m2;
  return std::sqrt(std::max(6 * r[0] - 8 * r[1] + 2 * r[2], 0.0)) / (interval_s * interval_s);
}

SeaModel model_of_density(const Eigen::VectorXd& density, double df_hz, double interval_s, int order,
                          double ridge) {
  SeaModel model;
  model.interval_s = interval_s;
  model.autocovariance_m2.resize(order + 1);
  const Eigen::Index bins = density.size();
  const Eigen::ArrayXd w =
      Eigen::ArrayXd::LinSpaced(bins, 0, 2 * std::numbers::pi * df_hz * static_cast<double>(bins - 1));
  const Eigen::ArrayXd cos1 = (w * interval_s).cos();
  Eigen::ArrayXd weight = 2 * df_hz * density.array();
  weight[0] = 0;
  // cos((j - 1) w dt) and cos(j w dt), by Chebyshev's recurrence.
  Eigen::ArrayXd before = cos1, now = Eigen::ArrayXd::Ones(bins);
  for (int j = 0; j <= order; ++j) {
    model.autocovariance_m2[j] = (weight * now).sum();
    before = 2 * cos1 * now - before;
    before.swap(now);
  }
  const double m2 = (weight * w.square()).sum();
  model.mean_frequency_radps =
      model.autocovariance_m2[0] > 0 ? std::sqrt(m2 / model.autocovariance_m2[0]) : 0.0;
  model.autocovariance_m2[0] *= 1 + ridge;
  const Predictors<1> predictors = levinson(model.autocovariance_m2);
  model.ar = predictors.coefficients.back();
  model.innovation_m2 = predictors.variance.back().value();
  return model;
}

// S(f) ~ f^-5 exp(-5/4 (fp/f)^4), whose integral is 1 / (5 fp^4).
Eigen::VectorXd pierson_moskowitz_m2s(double variance_m2, double tp_s, Eigen::Index bins, double df_hz) {
  const Eigen::ArrayXd f_hz = Eigen::ArrayXd::LinSpaced(bins, 0, df_hz * static_cast<double>(bins - 1));
  const Eigen::ArrayXd x4 = (tp_s * f_hz).square().square().inverse();
  Eigen::VectorXd density_m2s = variance_m2 / 2 * 5 * x4 / f_hz * (-1.25 * x4).exp();
  density_m2s[0] = 0;
  return density_m2s;
}

Eigen::VectorXd unknown_sea_density_m2s(Eigen::Index bins, double df_hz) {
  return pierson_moskowitz_m2s(kUnknownSea_m2, kUnknownPeak_s, bins, df_hz);
}

SeaModel unknown_sea(double interval_s, int order, double accel_noise_m2ps3) {
  constexpr int kBins = 512;
  const double df = 0.5 / kFineInterval_s / kBins;
  SeaModel model =
      model_of_density(unknown_sea_density_m2s(kBins + 1, df), df, interval_s, order, kUnknownRidge);
  model.set_noise(accel_noise_m2ps3);
  return model;
}

double suited_interval_s(const Eigen::VectorXd& density, double df_hz, double present_s) {
  const auto fast = std::min<Eigen::Index>(std::lround(kFast_hz / df_hz), density.size());
  const double share = density.tail(density.size() - fast).sum() / density.sum();
  const double enough = present_s > kFineInterval_s ? kFastShare : kFastShare / 2;  // no change to and fro
  return share > enough ? kFineInterval_s : 2 * kFineInterval_s;
}

}  // namespace waverig::estimator
