#include "estimator/evaluation/bound.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace waverig::evaluation {
namespace {

constexpr double kFewest = 5, kMost = 1e7;  // samples of a wave

}  // namespace

double height_bound_m(const BoundSettings& settings) {
  const double wanted = settings.period_s * settings.sample_rate_hz;
  if (!(wanted >= kFewest && wanted <= kMost) || !std::isfinite(settings.noise_density_mps2_rthz))
    return estimator::kUnknown;
  const auto samples = std::llround(wanted);
  const double w = 2 * std::numbers::pi / settings.period_s;
  // White noise of one-sided density nd has variance nd^2 rate / 2 at each sample.
  const double variance =
      settings.noise_density_mps2_rthz * settings.noise_density_mps2_rthz * settings.sample_rate_hz / 2;
  Eigen::Matrix4d fisher = Eigen::Matrix4d::Zero();
  for (long long i = 0; i < samples; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / settings.sample_rate_hz;
    // Drift scaled to the wave's length: the height's bound does not depend on it, the matrix' condition
    // does.
    const Eigen::Vector4d gradient(-w * w * std::cos(w * t), -w * w * std::sin(w * t), 1,
                                   t / settings.period_s - 0.5);
    fisher += gradient * gradient.transpose();
  }
  const Eigen::Matrix2d covariance = variance * fisher.inverse().topLeftCorner<2, 2>();
  const Eigen::Vector2d crest(std::cos(settings.crest_phase_rad), std::sin(settings.crest_phase_rad));
  return 2 * std::sqrt(crest.dot(covariance * crest));
}

}  // namespace waverig::evaluation
