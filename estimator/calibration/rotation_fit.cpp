#include "estimator/calibration/rotation_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "estimator/calibration/sample_steps.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Matrix39d = Eigen::Matrix<double, 3, 9>;

constexpr int kIterations = 30;
constexpr double kLeastCoverage = 0.05;

// Unknowns: A = I + symmetric(x0 x1 x2; x3 xy, x4 xz, x5 yz), c = A b = x6..8.
constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kCol[6] = {0, 1, 2, 1, 2, 2};

Matrix3d A_of(const Vector9d& x) {
  Matrix3d A = Matrix3d::Identity();
  for (int i = 0; i < 6; ++i) {
    A(kRow[i], kCol[i]) += x[i];
    if (i > 2) A(kCol[i], kRow[i]) += x[i];
  }
  return A;
}

// One window: v = offset + slope x, carried into the frame of its first sample.
struct Window {
  Vector3d offset = Vector3d::Zero();
  Matrix39d slope = Matrix39d::Zero();
};

struct Stretch {
  std::size_t begin = 0, end = 0;
};

std::vector<Stretch> stretches(std::span<const ImuSample> samples, const RotationFitSettings& settings) {
  const double longest_s = longest_step_s(samples);
  std::vector<Stretch> found;
  std::size_t begin = 0;
  while (begin + 1 < samples.size()) {
    std::size_t end = begin + 1, half = begin;
    bool gap = false;
    while (end < samples.size() && !gap) {
      const double step_s = static_cast<double>(samples[end].utime - samples[end - 1].utime) * kMicrosecond;
      const double length_s = static_cast<double>(samples[end].utime - samples[begin].utime) * kMicrosecond;
      gap = !(step_s > 0 && step_s <= longest_s);
      if (!gap && half == begin && length_s >= 0.5 * settings.window_s) half = end;
      if (!gap && length_s >= settings.window_s) break;
      ++end;
    }
    if (gap) {
      begin = end - 1;  // the sample after the gap; the loop went one past it
      continue;
    }
    if (end >= samples.size()) break;
    found.push_back({begin, end});
    begin = half;
  }
  return found;
}

Window carried(std::span<const ImuSample> samples, const Vector3d& gyro_offset) {
  Window window;
  Quaterniond q = Quaterniond::Identity();  // body at the sample to body at the first one
  Matrix3d R_sum = Matrix3d::Zero();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) {
      const double dt = static_cast<double>(samples[k].utime - samples[k - 1].utime) * kMicrosecond;
      const Vector3d rate = 0.5 * (samples[k].w_NB_B + samples[k - 1].w_NB_B) - gyro_offset;
      q = q * quaternion_exp(rate * dt);
    }
    const Matrix3d R = q.toRotationMatrix();
    const Vector3d& f = samples[k].f_B;
    window.offset += R * f;
    R_sum += R;
    for (int i = 0; i < 6; ++i) {
      window.slope.col(i) += R.col(kRow[i]) * f[kCol[i]];
      if (i > 2) window.slope.col(i) += R.col(kCol[i]) * f[kRow[i]];
    }
  }
  const double n = static_cast<double>(samples.size());
  window.slope.rightCols<3>() = -R_sum;
  window.offset /= n;
  window.slope /= n;
  return window;
}

// The gyroscope's zero: its mean over the windows in which it scatters no more than noise does.
GyroscopeCalibration gyroscope_at_rest(std::span<const ImuSample> samples, std::span<const Stretch> windows,
                                       double rest_scatter_radps) {
  std::vector<Vector3d> means;
  for (const Stretch& s : windows) {
    Vector3d sum = Vector3d::Zero(), square = Vector3d::Zero();
    for (std::size_t k = s.begin; k < s.end; ++k) {
      sum += samples[k].w_NB_B;
      square += samples[k].w_NB_B.cwiseAbs2();
    }
    const double n = static_cast<double>(s.end - s.begin);
    const Vector3d variance = square / n - (sum / n).cwiseAbs2();
    if (variance.maxCoeff() < rest_scatter_radps * rest_scatter_radps) means.push_back(sum / n);
  }
  GyroscopeCalibration result;
  result.offset_sigma_radps.setConstant(kUnknown);
  if (means.size() < 2) return result;
  Vector3d sum = Vector3d::Zero(), square = Vector3d::Zero();
  for (const Vector3d& m : means) sum += m;
  const double n = static_cast<double>(means.size());
  result.offset_radps = sum / n;
  for (const Vector3d& m : means) square += (m - result.offset_radps).cwiseAbs2();
  result.offset_sigma_radps = (square / (n * (n - 1))).cwiseSqrt();
  return result;
}

struct Normal {
  Matrix9d matrix = Matrix9d::Zero();
  Vector9d right = Vector9d::Zero();
  double weighted_squares = 0, squares = 0;
};

Normal normal_equations(const std::vector<Window>& windows, const Vector9d& x, double gravity,
                        double outlier) {
  Normal normal;
  for (const Window& w : windows) {
    const Vector3d v = w.offset + w.slope * x;
    const double length = v.norm(), residual = length - gravity;
    const Vector9d row = w.slope.transpose() * (v / length);
    const double weight = std::abs(residual) <= outlier ? 1 : outlier / std::abs(residual);
    normal.matrix += weight * row * row.transpose();
    normal.right -= weight * residual * row;
    normal.weighted_squares += weight * residual * residual;
    normal.squares += residual * residual;
  }
  return normal;
}

}  // namespace

RotationFit fit_rotation(std::span<const ImuSample> samples, double gravity_mps2,
                         const RotationFitSettings& settings) {
  // 1. Windows, and the gyroscope's zero from those at rest.
  const std::vector<Stretch> found = stretches(samples, settings);
  RotationFit fit;
  fit.windows = static_cast<int>(found.size());
  if (fit.windows < settings.fewest_windows)
    throw UserError(fmt::format("rotation calibration: {} windows of {} s: expected at least {}", fit.windows,
                                settings.window_s, settings.fewest_windows));
  fit.gyroscope = gyroscope_at_rest(samples, found, settings.rest_scatter_radps);

  // 2. Each window carried into one frame and averaged; how evenly the attitudes cover the sphere.
  std::vector<Window> windows;
  Matrix3d spread = Matrix3d::Zero();
  for (const Stretch& s : found) {
    windows.push_back(carried(samples.subspan(s.begin, s.end - s.begin), fit.gyroscope.offset_radps));
    for (std::size_t k = s.begin; k < s.end; ++k) {
      const Vector3d u = samples[k].f_B.normalized();
      spread += u * u.transpose() / static_cast<double>((s.end - s.begin) * found.size());
    }
  }
  fit.coverage = 3 * Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvalues()[0];
  if (!(fit.coverage >= kLeastCoverage))
    throw UserError(
        fmt::format("rotation calibration: coverage of attitudes {:.3f}: expected at least {} (turn the "
                    "sensor about all its axes)",
                    fit.coverage, kLeastCoverage));

  // 3. Gauss-Newton with Huber weights.
  Vector9d x = Vector9d::Zero();
  const double n = static_cast<double>(windows.size());
  fit.residual_before_mps2 =
      std::sqrt(normal_equations(windows, x, gravity_mps2, settings.outlier_mps2).squares / n);
  for (int i = 0; i < kIterations; ++i) {
    const Normal normal = normal_equations(windows, x, gravity_mps2, settings.outlier_mps2);
    const Vector9d step = normal.matrix.ldlt().solve(normal.right);
    x += step;
    if (step.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  const Normal normal = normal_equations(windows, x, gravity_mps2, settings.outlier_mps2);
  fit.residual_rms_mps2 = std::sqrt(normal.squares / n);

  // 4. Back to M and b, with the covariance. Windows overlap by half: half of them are independent.
  const Matrix3d A = A_of(x), M = A.inverse();
  const Vector3d c = x.tail<3>();
  fit.calibration.M = M;
  fit.calibration.b_mps2 = M * c;
  AccelerometerCorrection usable(fit.calibration);
  const Matrix9d covariance = normal.matrix.inverse() * normal.weighted_squares / std::max(1.0, 0.5 * n - 9);
  Eigen::Matrix<double, 12, 9> J = Eigen::Matrix<double, 12, 9>::Zero();
  for (int i = 0; i < 9; ++i) {
    const Matrix3d dA =
        i < 6 ? Matrix3d(A_of(Vector9d::Unit(i)) - Matrix3d::Identity()) : Matrix3d(Matrix3d::Zero());
    const Matrix3d dM = -M * dA * M;
    for (int r = 0; r < 3; ++r) J.block<3, 1>(3 * r, i) = dM.row(r).transpose();
    J.block<3, 1>(9, i) = dM * c;
    if (i >= 6) J.block<3, 1>(9, i) += M.col(i - 6);
  }
  fit.calibration.covariance.topLeftCorner<12, 12>() = J * covariance * J.transpose();
  return fit;
}

}  // namespace waverig::estimator
