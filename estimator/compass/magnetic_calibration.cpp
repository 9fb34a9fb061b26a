#include "estimator/compass/magnetic_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr std::size_t kFewest = 12;

[[noreturn]] void refuse(const char* why) {
  throw UserError(std::string("compass calibration: ") + why +
                  ": expected readings turned through all attitudes in a constant field");
}

Matrix3d symmetric(const Vector9d& p) {
  Matrix3d m;
  m << p[0], p[3], p[4], p[3], p[1], p[5], p[4], p[5], p[2];
  return m;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Vector3d median(std::span<const Vector3d> readings) {
  Vector3d result;
  std::vector<double> values(readings.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < readings.size(); ++i) values[i] = readings[i][axis];
    result[axis] = median(values);
  }
  return result;
}

// A start: x' Q x + 2 u' x = 1 by linear least squares, in readings centred and scaled to order one. A
// reading three times as far out as most is a spike, which would bend the start beyond repair.
MagneticCalibration algebraic_ellipsoid(std::span<const Vector3d> raw) {
  const Vector3d centre = median(raw);
  std::vector<double> distances(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) distances[i] = (raw[i] - centre).norm();
  const double scale = median(distances);
  if (!(scale > 0)) refuse("the readings do not differ");

  Eigen::Matrix<double, Eigen::Dynamic, 9> A(static_cast<Eigen::Index>(raw.size()), 9);
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (distances[i] > 3 * scale) continue;
    const Vector3d x = (raw[i] - centre) / scale;
    A.row(rows++) << x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), 2 * x.x() * x.y(), 2 * x.x() * x.z(),
        2 * x.y() * x.z(), 2 * x.x(), 2 * x.y(), 2 * x.z();
  }
  A.conservativeResize(rows, Eigen::NoChange);
  if (rows < static_cast<Eigen::Index>(kFewest)) refuse("fewer than 12 readings belong together");
  const Eigen::ColPivHouseholderQR<decltype(A)> qr(A);
  const auto diagonal = qr.matrixR().diagonal().cwiseAbs();
  if (diagonal.minCoeff() < 1e-4 * diagonal.maxCoeff()) refuse("the readings lie in a plane or on a circle");
  const Vector9d p = qr.solve(Eigen::VectorXd::Ones(A.rows()));
  const Matrix3d Q = symmetric(p);
  const Vector3d u = p.tail<3>();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(Q);
  if (!(eigen.eigenvalues().minCoeff() > 0)) refuse("the readings do not lie on an ellipsoid");
  const Vector3d offset = -Q.ldlt().solve(u);
  const double radius2 = 1 + offset.dot(Q * offset);
  return {eigen.operatorSqrt() / std::sqrt(radius2) / scale, centre + scale * offset};
}

}  // namespace

NormResidual norm_residual(std::span<const Vector3d> raw, const MagneticCalibration& calibration) {
  NormResidual residual;
  double sum = 0, square = 0, least = INFINITY, largest = 0;
  for (const Vector3d& r : raw) {
    const double norm = calibration.apply(r).norm();
    sum += norm;
    square += norm * norm;
    least = std::min(least, norm);
    largest = std::max(largest, norm);
  }
  const double n = static_cast<double>(raw.size());
  residual.mean = sum / n;
  residual.relative_std =
      std::sqrt(std::max(0.0, square / n - residual.mean * residual.mean)) / residual.mean;
  residual.relative_largest = std::max(largest - residual.mean, residual.mean - least) / residual.mean;
  return residual;
}

MagneticCalibration max_min_calibration(std::span<const Vector3d> raw) {
  if (raw.empty()) refuse("there are no readings");
  Vector3d least = raw[0], largest = raw[0];
  for (const Vector3d& r : raw) {
    least = least.cwiseMin(r);
    largest = largest.cwiseMax(r);
  }
  const Vector3d extent = largest - least;
  if (!(extent.minCoeff() > 0)) refuse("an axis does not change");
  return {Matrix3d(extent.cwiseInverse().asDiagonal() * 2.0), 0.5 * (largest + least)};  // eq. (8)
}

EllipsoidFit ellipsoid_calibration(std::span<const Vector3d> raw) {
  if (raw.size() < kFewest) refuse("fewer than 12 readings");
  EllipsoidFit fit;
  fit.calibration = algebraic_ellipsoid(raw);
  Matrix3d& G = fit.calibration.gain;
  Vector3d& o = fit.calibration.offset;

  Matrix9d normal = Matrix9d::Zero();
  std::vector<double> magnitudes(raw.size());
  double variance = 0;
  for (int iteration = 0; iteration < 30; ++iteration) {
    for (std::size_t i = 0; i < raw.size(); ++i)
      magnitudes[i] = std::abs(fit.calibration.apply(raw[i]).norm() - 1);
    const double bound = std::max(3 * 1.4826 * median(magnitudes), 1e-12);  // Huber, three robust sigmas
    normal.setZero();
    Vector9d right = Vector9d::Zero();
    double weighted = 0;
    for (const Vector3d& r : raw) {
      const Vector3d c = r - o, m = G * c;
      const double norm = m.norm(), error = norm - 1;
      const Vector3d n = m / norm, by_offset = -G * n;  // G symmetric
      Vector9d J;
      J << n.x() * c.x(), n.y() * c.y(), n.z() * c.z(), n.x() * c.y() + n.y() * c.x(),
          n.x() * c.z() + n.z() * c.x(), n.y() * c.z() + n.z() * c.y(), by_offset;
      const double weight = std::min(1.0, bound / std::max(std::abs(error), 1e-300));
      normal += weight * J * J.transpose();
      right -= weight * error * J;
      weighted += weight * error * error;
    }
    // Gain and offset differ by orders of magnitude in counts: precondition by the diagonal.
    const Vector9d d = normal.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix9d scaled = d.asDiagonal() * normal * d.asDiagonal();
    const Vector9d step = d.asDiagonal() * scaled.ldlt().solve(Vector9d(d.asDiagonal() * right));
    if (!step.allFinite()) refuse("the fit does not converge");
    G += symmetric(step);
    o += step.tail<3>();
    variance = weighted / static_cast<double>(raw.size() - 9);
    if ((step.array() * d.array().inverse()).matrix().norm() <
        1e-10 * std::sqrt(static_cast<double>(raw.size())))
      break;
  }
  const Vector9d d = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix9d scaled = d.asDiagonal() * normal * d.asDiagonal();
  fit.covariance = variance * (d.asDiagonal() * scaled.ldlt().solve(Matrix9d(d.asDiagonal())));
  fit.residual = norm_residual(raw, fit.calibration);
  return fit;
}

Alignment align_with_gravity(const MagneticCalibration& calibration, std::span<const Vector3d> raw,
                             std::span<const Vector3d> f_B) {
  if (raw.size() != f_B.size() || raw.size() < kFewest)
    refuse("fewer than 12 readings beside specific forces");
  // down . R m = sin(dip), R = exp(rotation): linear in the small rotation, Gauss-Newton. Unknowns: rotation,
  // sin(dip).
  Quaterniond q = Quaterniond::Identity();
  double sin_dip = 0, square = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    square = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const Vector3d down_B = -f_B[i].normalized();
      const Vector3d m_B = q * calibration.apply(raw[i]);
      const double error = down_B.dot(m_B) - sin_dip;
      Eigen::Vector4d J;
      J << m_B.cross(down_B), -1;
      normal += J * J.transpose();
      right -= error * J;
      square += error * error;
    }
    const Eigen::FullPivHouseholderQR<Eigen::Matrix4d> qr(normal);
    if (qr.rank() < 4) refuse("the attitudes do not differ enough to align with gravity");
    const Eigen::Vector4d step = qr.solve(right);
    q = quaternion_exp(step.head<3>()) * q;
    sin_dip += step[3];
    if (step.norm() < 1e-12) break;
  }
  const Eigen::AngleAxisd rotation(q);
  Alignment result;
  result.calibration = {q.toRotationMatrix() * calibration.gain, calibration.offset};
  result.rotation_B_rad = rotation.angle() * rotation.axis();
  result.dip_rad = std::asin(std::clamp(sin_dip, -1.0, 1.0));
  result.dip_std_rad =
      std::sqrt(square / static_cast<double>(raw.size())) / std::max(std::cos(result.dip_rad), 1e-6);
  return result;
}

std::vector<Quaterniond> level_turn(int steps) {
  std::vector<Quaterniond> attitudes;
  for (int i = 0; i < steps; ++i)
    attitudes.push_back(quaternion_of({0, 0, 2 * std::numbers::pi * i / steps}));
  return attitudes;
}

double north_from_level_turn(std::span<const Vector3d> raw) {
  // First harmonic of x over the turn: x = offset + gain cos(lam) cos(heading).
  double c = 0, s = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(raw.size());
    c += raw[i].x() * std::cos(phase);
    s += raw[i].x() * std::sin(phase);
  }
  if (std::hypot(c, s) == 0) refuse("the x axis does not change over the level turn");
  return std::atan2(-s, c);
}

std::vector<Quaterniond> pitch_turn(double north_rad, int steps) {
  std::vector<Quaterniond> attitudes;
  for (int i = 0; i < steps; ++i)
    attitudes.push_back(quaternion_of({0, 0, -north_rad}) *
                        quaternion_of({0, 2 * std::numbers::pi * i / steps, 0}));
  return attitudes;
}

std::vector<Quaterniond> roll_turn(double north_rad, int steps) {
  const double heading_rad = -north_rad - std::numbers::pi / 2;  // then y points north
  std::vector<Quaterniond> attitudes;
  for (int i = 0; i < steps; ++i)
    attitudes.push_back(quaternion_of({0, 0, heading_rad}) *
                        quaternion_of({2 * std::numbers::pi * i / steps, 0, 0}));
  return attitudes;
}

}  // namespace waverig::estimator
