// TemperatureLaw: a quantity as a polynomial in temperature with its covariance, of the order that the data ask for.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace waverig::estimator {

struct TemperatureLaw {
  double reference_degC = 20;
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(1);       // of (T - reference)^0, ^1, …
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(1, 1);      // of the coefficients
  double from_degC = -273.15, to_degC = 1000;                    // where it was measured

  int order() const { return static_cast<int>(coefficients.size()) - 1; }
  double at(double temperature_degC) const;
  double sigma_at(double temperature_degC) const;                // standard uncertainty
};

struct TemperaturePoint {
  double temperature_degC = 0;
  double value = 0;
  double sigma = 0;   // standard uncertainty of the part that differs from point to point
};

struct TemperatureLawSettings {
  double reference_degC = 20;
  int order_max = 3;
  bool sigma_known = true;    // false: the sigmas are relative weights, the scatter about the highest order scales them
};

struct TemperatureLawFit {
  TemperatureLaw law;
  std::vector<double> chi_squared;   // by order tried, from 0
  double dispersion = 1;             // factor on the sigmas where the points scatter more than they state (Birge)
};

// The lowest order that no higher one beats significantly (95 % of chi-squared). Needs one point more than the order
// it may choose; throws std::invalid_argument without points.
TemperatureLawFit fit_temperature_law(const std::vector<TemperaturePoint>& points, const TemperatureLawSettings& settings);

}  // namespace waverig::estimator
