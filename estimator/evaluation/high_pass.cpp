#include "estimator/evaluation/high_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig::evaluation {
namespace {

// Bilinear transform of s^2 / (s^2 + sqrt(2) w s + w^2), w prewarped; in place, from rest at the first value.
void filter(std::vector<double>& x, double sample_rate_hz, double cut_off_hz) {
  const double k = std::tan(std::numbers::pi * cut_off_hz / sample_rate_hz);
  const double norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
  const double a1 = 2 * (k * k - 1) * norm, a2 = (1 - std::numbers::sqrt2 * k + k * k) * norm;
  double x1 = x.front(), x2 = x.front(), y1 = 0, y2 = 0;
  for (double& value : x) {
    const double y = norm * (value - 2 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

}  // namespace

std::vector<double> high_passed(std::span<const double> values, double sample_rate_hz, double cut_off_hz) {
  if (values.size() < 2) return std::vector<double>(values.size(), 0.0);
  // The ends are reflected through their last value, so that neither offset nor slope makes a step there.
  const auto wanted = static_cast<std::size_t>(3 * sample_rate_hz / cut_off_hz);
  const std::size_t pad = std::min(values.size() - 1, wanted);
  std::vector<double> x;
  x.reserve(values.size() + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) x.push_back(2 * values.front() - values[i]);
  x.insert(x.end(), values.begin(), values.end());
  for (std::size_t i = 0; i < pad; ++i) x.push_back(2 * values.back() - values[values.size() - 2 - i]);
  for (int direction = 0; direction < 2; ++direction) {
    filter(x, sample_rate_hz, cut_off_hz);
    std::reverse(x.begin(), x.end());
  }
  return {x.begin() + static_cast<std::ptrdiff_t>(pad), x.end() - static_cast<std::ptrdiff_t>(pad)};
}

}  // namespace waverig::evaluation
