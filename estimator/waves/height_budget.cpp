#include "estimator/waves/height_budget.h"

#include <algorithm>
#include <array>

namespace waverig::estimator {
namespace {

constexpr int kParameters = 12;  // E row by row, then b
constexpr std::size_t kInstants = 40;
using Vector12 = Eigen::Matrix<double, kParameters, 1>;

Vector12 prior_variances(const SensorKnowledge& k) {
  Vector12 v;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) v(3 * i + j) = i == j ? k.accel_scale_sigma : k.accel_misalignment_sigma_rad;
    v(9 + i) = k.accel_bias_sigma_mps2;
  }
  return v.array().square();
}

// Sums over the instants of one wave that give a signal's mean and its part in phase with the wave.
struct Projection {
  double sum = 0, in_phase = 0;
  void add(double value, double phase) {
    sum += value;
    in_phase += value * phase;
  }
};

}  // namespace

AmplitudeBudget amplitude_budget(const WaveSeries& series, const WaveFit& fit,
                                 const SensorKnowledge& knowledge, double mean_up_mps2,
                                 double mean_up_sigma_mps2) {
  const BinRange range = range_of(series, fit.begin_s, fit.end_s);
  const std::size_t stride = std::max<std::size_t>(1, range.size() / kInstants);
  const double amplitude = fit.amplitude_mps2(), g = knowledge.gravity_mps2;
  std::array<Projection, kParameters> up;
  std::array<Eigen::Vector2d, kParameters> horizontal;
  horizontal.fill(Eigen::Vector2d::Zero());
  Projection unit, north, east;
  double phase_squares = 0, n = 0;
  Vector3d up_B = Vector3d::Zero();
  for (std::size_t i = range.first; i < range.last; i += stride) {
    const Bin& bin = series.bins()[i];
    const double angle = fit.omega_radps * (bin.t_s - fit.middle_s);
    const double phase = (fit.cos_mps2 * std::cos(angle) + fit.sin_mps2 * std::sin(angle)) / amplitude;
    const Matrix3d R_NB = bin.q_NB.toRotationMatrix();
    const Vector3d f_N = R_NB * bin.f_B;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d e_N = R_NB.col(axis);
      for (int j = 0; j < 4; ++j) {
        const double force = j < 3 ? bin.f_B(j) : 1.0;
        const auto p = static_cast<std::size_t>(j < 3 ? 3 * axis + j : 9 + axis);
        up[p].add(-e_N.z() * force, phase);
        horizontal[p] += e_N.head<2>() * force;
      }
    }
    north.add(f_N.x(), phase);
    east.add(f_N.y(), phase);
    unit.add(1, phase);
    phase_squares += phase * phase;
    up_B -= R_NB.row(2).transpose();
    n += 1;
  }
  AmplitudeBudget budget;
  if (n < 8) return budget;
  up_B.normalize();
  // Least squares for (in-phase amplitude, mean) of a signal.
  const double det = phase_squares - unit.in_phase * unit.in_phase / n;
  const auto amplitude_of = [&](const Projection& s) {
    return (s.in_phase - s.sum * unit.in_phase / n) / det;
  };
  const Eigen::Vector2d a_h(amplitude_of(north), amplitude_of(east));

  Vector12 sensitivity, level_sensitivity, mean_sensitivity;
  for (int p = 0; p < kParameters; ++p) {
    const auto i = static_cast<std::size_t>(p);
    sensitivity(p) = amplitude_of(up[i]) + (horizontal[i] / n).dot(a_h) / g;
    mean_sensitivity(p) = up[i].sum / n;
    level_sensitivity(p) = p < 9 ? up_B(p / 3) * up_B(p % 3) * amplitude : 0.0;
  }
  const Vector12 prior = prior_variances(knowledge);
  const Vector12 gain_numerator = prior.cwiseProduct(mean_sensitivity);
  const double innovation_variance = mean_sensitivity.dot(gain_numerator) +
                                     mean_up_sigma_mps2 * mean_up_sigma_mps2 +
                                     knowledge.gravity_sigma_mps2 * knowledge.gravity_sigma_mps2;
  const auto variance_of = [&](const Vector12& h) {
    const double shared = h.dot(gain_numerator);
    const double known = innovation_variance > 0 ? shared * shared / innovation_variance : 0;
    return std::max(0.0, h.dot(prior.cwiseProduct(h)) - known);
  };
  if (innovation_variance > 0) {
    budget.correction_mps2 = sensitivity.dot(gain_numerator) / innovation_variance * mean_up_mps2;
  }
  const double slope = knowledge.accel_slope_sigma * amplitude;
  budget.calibration_sigma_mps2 = std::sqrt(variance_of(level_sensitivity) + slope * slope);
  budget.tilt_sigma_mps2 = std::sqrt(variance_of(sensitivity - level_sensitivity));
  return budget;
}

}  // namespace waverig::estimator
