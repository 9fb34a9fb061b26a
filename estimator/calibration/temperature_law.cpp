#include "estimator/calibration/temperature_law.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace waverig::estimator {
namespace {

// 95 % quantiles of chi-squared with 1, 2, … degrees of freedom.
constexpr std::array kChiSquared95 = {3.841, 5.991, 7.815, 9.488, 11.070, 12.592, 14.067, 15.507};

Eigen::VectorXd powers(double x, int order) {
  Eigen::VectorXd p(order + 1);
  p[0] = 1;
  for (int k = 1; k <= order; ++k) p[k] = p[k - 1] * x;
  return p;
}

struct Solution {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  double chi_squared = 0;
};

// Weighted least squares in the scaled temperature u = (T - reference) / scale, so that every column is of order one.
Solution solve(const std::vector<TemperaturePoint>& points, int order, double reference_degC, double scale) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd A(rows, order + 1);
  Eigen::VectorXd y(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const TemperaturePoint& p = points[static_cast<std::size_t>(i)];
    A.row(i) = powers((p.temperature_degC - reference_degC) / scale, order).transpose() / p.sigma;
    y[i] = p.value / p.sigma;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  const Eigen::VectorXd c = qr.solve(y);
  const Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd::Identity(rows, rows));
  const Eigen::VectorXd unscale = powers(1 / scale, order);
  return {c.cwiseProduct(unscale),
          unscale.asDiagonal() * (inverse * inverse.transpose()) * unscale.asDiagonal(), (A * c - y).squaredNorm()};
}

}  // namespace

double TemperatureLaw::at(double temperature_degC) const {
  const double x = temperature_degC - reference_degC;
  double value = 0;
  for (Eigen::Index k = coefficients.size() - 1; k >= 0; --k) value = value * x + coefficients[k];
  return value;
}

double TemperatureLaw::sigma_at(double temperature_degC) const {
  const Eigen::VectorXd p = powers(temperature_degC - reference_degC, order());
  return std::sqrt(std::max(0.0, p.dot(covariance * p)));
}

TemperatureLawFit fit_temperature_law(const std::vector<TemperaturePoint>& points,
                                      const TemperatureLawSettings& settings) {
  if (points.empty()) throw std::invalid_argument("a temperature law needs at least one point");
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.temperature_degC < b.temperature_degC;
  });
  const double span = high->temperature_degC - low->temperature_degC;
  const double scale = span > 0 ? span / 2 : 1;
  const int count = static_cast<int>(points.size());
  const int order_max = span > 0 ? std::clamp(count - 2, 0, settings.order_max) : 0;

  std::vector<Solution> solutions;
  for (int order = 0; order <= order_max; ++order)
    solutions.push_back(solve(points, order, settings.reference_degC, scale));

  TemperatureLawFit fit;
  for (const Solution& s : solutions) fit.chi_squared.push_back(s.chi_squared);
  const int freedom = count - 1 - order_max;
  const double reduced = freedom > 0 ? solutions.back().chi_squared / freedom : 1;
  const double unit = settings.sigma_known ? 1 : std::max(reduced, 1e-300);

  int chosen = order_max;
  for (int order = order_max - 1; order >= 0; --order) {
    bool beaten = false;
    for (int higher = order + 1; higher <= order_max; ++higher) {
      const std::size_t extra = std::min<std::size_t>(static_cast<std::size_t>(higher - order), kChiSquared95.size());
      beaten = beaten || (fit.chi_squared[static_cast<std::size_t>(order)] -
                          fit.chi_squared[static_cast<std::size_t>(higher)]) / unit > kChiSquared95[extra - 1];
    }
    if (!beaten) chosen = order;
  }

  const Solution& best = solutions[static_cast<std::size_t>(chosen)];
  const int left = count - 1 - chosen;
  const double birge = left > 0 ? best.chi_squared / left : 1;
  fit.dispersion = std::sqrt(settings.sigma_known ? std::max(1.0, birge) : birge);
  fit.law = {settings.reference_degC, best.coefficients, fit.dispersion * fit.dispersion * best.covariance,
             low->temperature_degC, high->temperature_degC};
  return fit;
}

}  // namespace waverig::estimator
