#include "estimator/evaluation/heave_comparison.h"

#include <algorithm>
#include <cmath>

namespace waverig::evaluation {
namespace {

// Heave and rate of a motion are hardly correlated. Where they are the same but for a factor, as at samples
// that all meet the same two points of a wave, neither gain nor lag is to be had.
constexpr double kLeastIndependent = 1e-3;

}  // namespace

void HeaveComparison::add(double heave_m, double true_heave_m, double true_rate_mps, double sigma_m) {
  const double h = heave_m, t = true_heave_m, r = true_rate_mps, e = h - t;
  n_ += 1;
  e_ += e;
  ee_ += e * e;
  h_ += h;
  t_ += t;
  r_ += r;
  tt_ += t * t;
  rr_ += r * r;
  tr_ += t * r;
  ht_ += h * t;
  hr_ += h * r;
  if (!(sigma_m > 0)) return;
  const double weight = 1 / (sigma_m * sigma_m);
  stated_ += 1;
  weight_ += weight;
  weighted_e_ += weight * e;
  weighted_ee_ += weight * e * e;
}

double HeaveComparison::rmse_m() const {
  return n_ > 0 ? std::sqrt(std::max(0.0, ee_ / n_ - e_ * e_ / (n_ * n_))) : estimator::kUnknown;
}

double HeaveComparison::true_std_m() const {
  return n_ > 0 ? std::sqrt(std::max(0.0, tt_ / n_ - t_ * t_ / (n_ * n_))) : estimator::kUnknown;
}

HeaveComparison::Regression HeaveComparison::regression() const {
  if (n_ < 3) return {estimator::kUnknown, estimator::kUnknown, estimator::kUnknown};
  const double tt = tt_ - t_ * t_ / n_, rr = rr_ - r_ * r_ / n_, tr = tr_ - t_ * r_ / n_;
  const double ht = ht_ - h_ * t_ / n_, hr = hr_ - h_ * r_ / n_;
  const double determinant = tt * rr - tr * tr;
  if (!(determinant > kLeastIndependent * tt * rr))
    return {estimator::kUnknown, estimator::kUnknown, estimator::kUnknown};
  return {(ht * rr - hr * tr) / determinant, (hr * tt - ht * tr) / determinant, std::sqrt(rr / tt)};
}

double HeaveComparison::gain() const {
  const Regression fit = regression();
  return std::hypot(fit.a, fit.b * fit.w);
}

double HeaveComparison::lag_s() const {
  const Regression fit = regression();
  return std::atan2(-fit.b * fit.w, fit.a) / fit.w;
}

double HeaveComparison::sigma_ratio() const {
  if (stated_ < 2) return estimator::kUnknown;
  return std::sqrt(std::max(0.0, weighted_ee_ - weighted_e_ * weighted_e_ / weight_) / stated_);
}

}  // namespace waverig::evaluation
