#include "estimator/attitude/lee_attitude.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace waverig::estimator {
namespace {

// Lee 2014, eq. (6): the matrix of p, q, r, quaternion scalar first.
Eigen::Matrix4d omega_matrix(const Vector3d& w) {
  const double p = w.x(), q = w.y(), r = w.z();
  Eigen::Matrix4d m;
  m << 0, -p, -q, -r, p, 0, r, -q, q, -r, 0, p, r, q, -p, 0;
  return m;
}

Eigen::Vector4d coefficients(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

Euler rest_attitude(const Vector3d& f_B, double g) {
  const double pitch = std::asin(std::clamp(f_B.x() / g, -1.0, 1.0));  // eq. (3)
  const double roll =
      std::asin(std::clamp(-f_B.y() / std::max(g * std::cos(pitch), 1e-9), -1.0, 1.0));  // eq. (4)
  return {roll, pitch, 0};
}

Vector3d levelled(const Vector3d& f_B, double roll, double pitch) {
  const double y = std::cos(roll) * f_B.y() - std::sin(roll) * f_B.z();
  const double z = std::sin(roll) * f_B.y() + std::cos(roll) * f_B.z();
  return {std::cos(pitch) * f_B.x() + std::sin(pitch) * z, y,
          -std::sin(pitch) * f_B.x() + std::cos(pitch) * z};
}

const Quaterniond& LeeAttitude::update(const Vector3d& f_B, const Vector3d& w_B, double dt_s) {
  Euler rest = rest_attitude(f_B, settings_.gravity_mps2);
  if (!started_) {
    started_ = true;
    q_ = quaternion_of(rest);
    return q_;
  }
  // Both variances are the data sheet's: white noise of one-sided density d has variance d^2 / (2 dt) per
  // sample and, integrated, walks by d^2 dt / 2; a quaternion element has a quarter of its angle's variance.
  const double angle_noise = settings_.accel_noise_mps2_rthz / settings_.gravity_mps2;
  const double R = 0.25 * angle_noise * angle_noise / (2 * dt_s);
  const double Q = 0.25 * settings_.gyro_noise_radps_rthz * settings_.gyro_noise_radps_rthz * dt_s / 2;
  // Predict, eq. (6).
  const Eigen::Matrix4d F = Eigen::Matrix4d::Identity() + 0.5 * dt_s * omega_matrix(w_B);
  Eigen::Vector4d q = F * coefficients(q_);
  P_ = F * P_ * F.transpose();
  P_.diagonal().array() += Q;

  // Correct, eq. (7): the state itself is measured. q and -q are the same attitude: take the near one.
  rest.yaw_rad = euler_of(Quaterniond(q(0), q(1), q(2), q(3)).normalized()).yaw_rad;
  Eigen::Vector4d z = coefficients(quaternion_of(rest));
  if (z.dot(q) < 0) z = -z;
  Eigen::Matrix4d S = P_;
  S.diagonal().array() += R;
  const Eigen::Matrix4d K = P_ * S.inverse();
  q += K * (z - q);
  P_ -= K * P_;
  q_ = Quaterniond(q(0), q(1), q(2), q(3)).normalized();
  return q_;
}

}  // namespace waverig::estimator
