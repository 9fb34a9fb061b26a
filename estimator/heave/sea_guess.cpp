#include "estimator/heave/sea_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "estimator/heave/node_spectrum.h"

namespace waverig::estimator {
namespace {

constexpr int kOrder = 40;
// Peak periods: kUsual_s, which is the shortest of a usual sea, times powers of kRatio.
constexpr double kUsual_s = 2, kRatio = 1.15;
constexpr int kShorter = 10, kLonger = 15, kPeriods = kShorter + 1 + kLonger;
constexpr double kSteepness_s2m = 0.035;           // Hm0 = kSteepness Tp^2, a usual sea
constexpr std::array kHeights = {1.0, 0.1, 0.01};  // of the usual; the least is noise
// Where the spectrum ends, peak frequencies; the last does not.
constexpr std::array kTailEnds = {3.0, 3.6, 4.3, 5.2, 6.2, 7.5, 9.0, 1e3};
constexpr double kRidge = 1e-6;       // of the variance, white
constexpr double kPriorValues = 1;    // as many values say that the size is the candidate's
constexpr double kNegligible = 1e-8;  // likelihood, beside the best one's
constexpr int kFolds = 3;             // times the nodes' own frequencies: as far as short seas go on

// What nodes see, up to half their rate, of a density that goes on above it.
Eigen::VectorXd folded(const Eigen::VectorXd& density, Eigen::Index bins) {
  Eigen::VectorXd seen = density.head(bins);
  const Eigen::Index period = 2 * (bins - 1);
  for (Eigen::Index i = bins; i < density.size(); ++i)
    seen[std::min(i % period, period - i % period)] += density[i];
  return seen;
}

}  // namespace

SeaGuess::SeaGuess(double dt_s, Eigen::Index bins, double accel_noise_m2ps3, double offset_sigma_mps2)
    : newest_(Eigen::VectorXd::Zero(kOrder)) {
  const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(bins, 0, std::numbers::pi);  // a node
  const double df_hz = w[1] / (2 * std::numbers::pi * dt_s);
  const Eigen::VectorXd turned = 2 - 2 * w.array().cos();
  const Eigen::VectorXd noise = noise_density_m2s(w, accel_noise_m2ps3, dt_s);
  const double offset_m = offset_sigma_mps2 * dt_s * dt_s;
  Eigen::MatrixXd lags(kOrder + 1, bins);
  for (int j = 0; j <= kOrder; ++j) lags.row(j) = (j * w.array()).cos();
  const Eigen::VectorXd noise_r_m2 = lags * noise;
  Eigen::MatrixXd r_m2(kPeriods * std::ssize(kTailEnds) * std::ssize(kHeights), kOrder + 1);
  for (int p = -kShorter; p <= kLonger; ++p) {
    const double tp_s = kUsual_s * std::pow(kRatio, p), hm0_m = kSteepness_s2m * tp_s * tp_s;
    // A candidate is weighed over its variance, which goes with Tp^4: below what is usual, the shorter are
    // not to count the more for it.
    const double usual = std::min(std::pow(tp_s / kUsual_s, 4), 1.0);
    const Eigen::VectorXd whole =
        pierson_moskowitz_m2s(hm0_m * hm0_m / 16, tp_s, kFolds * (bins - 1) + 1, df_hz);
    for (const double end : kTailEnds) {
      const auto length = static_cast<Eigen::Index>(std::ceil(end / (tp_s * df_hz)));
      Eigen::VectorXd cut = whole;
      cut.tail(std::max(cut.size() - length, Eigen::Index{0})).setZero();
      const Eigen::VectorXd sea = folded(cut, bins);
      const Eigen::VectorXd sea_r_m2 = lags * turned.cwiseAbs2().cwiseProduct(sea);
      for (const double height : kHeights) {
        if (height < 1 && usual < 1) break;  // those are low enough
        auto r = r_m2.row(std::ssize(candidates_));
        r = 2 * df_hz * (height * height * sea_r_m2 + noise_r_m2);
        candidates_.push_back({.shape = sea / sea.sum(),
                               .sum_m2s = height * height * sea.sum(),
                               .prior = usual * std::pow(height, 3),
                               .variance_m2 = r[0]});
        r[0] *= 1 + kRidge;
        r.array() += offset_m * offset_m;
      }
    }
  }
  r_m2.conservativeResize(std::ssize(candidates_), Eigen::NoChange);
  predictors_ = levinson(r_m2);
  for (const Eigen::ArrayXd& variance_m2 : predictors_.variance)
    log_variances_of_.push_back(variance_m2.log());
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
  const int order = std::min(in_a_row_, kOrder);
  const auto p = static_cast<std::size_t>(order);
  const Eigen::VectorXd predicted = predictors_.coefficients[p] * newest_.head(order);
  errors_ += (second_difference_m - predicted.array()).square() / predictors_.variance[p];
  log_variances_ += log_variances_of_[p];
  for (Eigen::Index i = kOrder - 1; i > 0; --i) newest_[i] = newest_[i - 1];
  newest_[0] = second_difference_m;
  ++seen_;
  ++in_a_row_;
}

SeaGuess::Guess SeaGuess::guess() const {
  const double n = seen_ + kPriorValues;
  const Eigen::ArrayXd size = (errors_ + kPriorValues) / n;
  const Eigen::ArrayXd log_likelihood = -0.5 * (n * size.log() + log_variances_);
  const Eigen::ArrayXd likelihood = (log_likelihood - log_likelihood.maxCoeff()).exp();
  Eigen::VectorXd density = Eigen::VectorXd::Zero(candidates_.front().shape.size());
  double sum = 0, weights = 0, mean = 0;
  for (Eigen::Index i = 0; i < likelihood.size(); ++i) {
    if (likelihood[i] < kNegligible) continue;
    const Candidate& c = candidates_[static_cast<std::size_t>(i)];
    const double by_variance = (squares_m2_ / c.variance_m2 + kPriorValues) / n;
    const double weight = c.prior * likelihood[i];  // times the sea's own sum
    density += weight * c.shape;
    const double sea_m2s = std::max(size[i], by_variance) * c.sum_m2s;
    sum += weight / sea_m2s;
    weights += weight;
    mean += weight * sea_m2s;
  }
  return {density / sum, mean * sum / (weights * weights)};
}

}  // namespace waverig::estimator
