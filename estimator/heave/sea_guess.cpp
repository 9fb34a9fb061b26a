#include "estimator/heave/sea_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waverig::estimator {
namespace {

constexpr int kOrder = 40;
constexpr int kPeriods = 16;
constexpr double kShortest_s = 2, kRatio = 1.15;   // of the peak periods
constexpr double kSteepness_s2m = 0.035;           // Hm0 = kSteepness Tp^2, a usual sea
constexpr std::array kHeights = {1.0, 0.1, 0.01};  // of the usual; the least is noise
// Where the spectrum ends, peak frequencies; the last does not.
constexpr std::array kTailEnds = {3.0, 3.6, 4.3, 5.2, 6.2, 7.5, 9.0, 1e3};
constexpr double kRidge = 1e-6;       // of the variance, white
constexpr double kPriorValues = 1;    // as many values say that the size is the candidate's
constexpr double kNegligible = 1e-8;  // likelihood, beside the best one's

}  // namespace

SeaGuess::SeaGuess(double dt_s, Eigen::Index bins, double accel_noise_m2ps3, double offset_sigma_mps2)
    : newest_(Eigen::VectorXd::Zero(kOrder)) {
  const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(bins, 0, std::numbers::pi);  // a node
  const double df_hz = w[1] / (2 * std::numbers::pi * dt_s);
  const Eigen::VectorXd turned = 2 - 2 * w.array().cos();
  const Eigen::VectorXd noise = accel_noise_m2ps3 * std::pow(dt_s, 4) * (2 + w.array().cos()) / 3;
  const double offset_m = offset_sigma_mps2 * dt_s * dt_s;
  Eigen::MatrixXd lags(kOrder + 1, bins);
  for (int j = 0; j <= kOrder; ++j) lags.row(j) = (j * w.array()).cos();
  const Eigen::VectorXd noise_r_m2 = lags * noise;
  std::vector<Predictors> predictors;
  for (int p = 0; p < kPeriods; ++p) {
    const double tp_s = kShortest_s * std::pow(kRatio, p), hm0_m = kSteepness_s2m * tp_s * tp_s;
    const Eigen::VectorXd usual = pierson_moskowitz_m2s(hm0_m * hm0_m / 16, tp_s, bins, df_hz);
    for (const double end : kTailEnds) {
      Eigen::VectorXd sea = usual;
      sea.tail(std::max(bins - static_cast<Eigen::Index>(std::ceil(end / (tp_s * df_hz))), Eigen::Index{0}))
          .setZero();
      const Eigen::VectorXd sea_r_m2 = lags * turned.cwiseAbs2().cwiseProduct(sea);
      for (const double height : kHeights) {
        Eigen::VectorXd r = 2 * df_hz * (height * height * sea_r_m2 + noise_r_m2);
        candidates_.push_back(
            {.density_m2s = height * height * sea, .prior = std::pow(height, 3), .variance_m2 = r[0]});
        r[0] *= 1 + kRidge;
        r.array() += offset_m * offset_m;
        predictors.push_back(levinson(r));
      }
    }
  }
  const auto count = std::ssize(candidates_);
  for (int m = 0; m <= kOrder; ++m) {
    const auto order = static_cast<std::size_t>(m);
    OnePredictors one{Eigen::MatrixXd(count, m), Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const Predictors& p = predictors[static_cast<std::size_t>(i)];
      one.coefficients.row(i) = p.coefficients[order];
      one.variance_m2[i] = p.variance[order];
    }
    one.log_variance = one.variance_m2.log();
    predictors_.push_back(std::move(one));
  }
  restart();
}

void SeaGuess::restart() {
  errors_ = log_variances_ = Eigen::ArrayXd::Zero(std::ssize(candidates_));
  seen_ = in_a_row_ = 0;
  mean_m_ = squares_m2_ = 0;
}

void SeaGuess::gap() { in_a_row_ = 0; }

void SeaGuess::add(double second_difference_m) {
  const double off_m = second_difference_m - mean_m_;  // Welford 1962
  mean_m_ += off_m / (seen_ + 1);
  squares_m2_ += off_m * (second_difference_m - mean_m_);
  const OnePredictors& p = predictors_[static_cast<std::size_t>(std::min(in_a_row_, kOrder))];
  const Eigen::VectorXd predicted = p.coefficients * newest_.head(p.coefficients.cols());
  errors_ += (second_difference_m - predicted.array()).square() / p.variance_m2;
  log_variances_ += p.log_variance;
  for (Eigen::Index i = kOrder - 1; i > 0; --i) newest_[i] = newest_[i - 1];
  newest_[0] = second_difference_m;
  ++seen_;
  ++in_a_row_;
}

Eigen::VectorXd SeaGuess::density_m2s() const {
  const double n = seen_ + kPriorValues;
  const Eigen::ArrayXd size = (errors_ + kPriorValues) / n;
  const Eigen::ArrayXd log_likelihood = -0.5 * (n * size.log() + log_variances_);
  const Eigen::ArrayXd likelihood = (log_likelihood - log_likelihood.maxCoeff()).exp();
  Eigen::VectorXd density = Eigen::VectorXd::Zero(candidates_.front().density_m2s.size());
  double sum = 0;
  for (Eigen::Index i = 0; i < likelihood.size(); ++i) {
    if (likelihood[i] < kNegligible) continue;
    const Candidate& c = candidates_[static_cast<std::size_t>(i)];
    const double by_variance = (squares_m2_ / c.variance_m2 + kPriorValues) / n;
    const Eigen::VectorXd sea = std::max(size[i], by_variance) * c.density_m2s;
    const double weight = c.prior * likelihood[i] / sea.sum();
    density += weight * sea;
    sum += weight;
  }
  return density / sum;
}

}  // namespace waverig::estimator
