// Frames and rotations. Navigation frame N: north, east, down. Body frame B: x forward, y right, z down.
// R_NB maps a vector from B to N; quaternions are Hamilton, scalar first, body to navigation.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

inline constexpr double kDegree = std::numbers::pi / 180.0;  // rad
inline constexpr double kStandardGravity = 9.80665;          // m/s^2, CGPM 1901; the unit "g"
inline constexpr double kMicrosecond = 1e-6;                 // s
inline constexpr double kCentimetre = 1e-2;                  // m

struct Euler {
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
};

// C_b^n = Rz(psi) Ry(theta) Rx(phi), REFERENCE section 0.
inline Quaterniond quaternion_of(const Euler& e) {
  return Quaterniond(Eigen::AngleAxisd(e.yaw_rad, Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(e.pitch_rad, Vector3d::UnitY()) *
                     Eigen::AngleAxisd(e.roll_rad, Vector3d::UnitX()));
}

inline Euler euler_of(const Quaterniond& q_NB) {
  const double w = q_NB.w(), x = q_NB.x(), y = q_NB.y(), z = q_NB.z();
  const double sin_pitch = std::clamp(2 * (w * y - z * x), -1.0, 1.0);
  return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), std::asin(sin_pitch),
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

// The rotation by the rotation vector phi (rad), exact for any size.
inline Quaterniond quaternion_exp(const Vector3d& phi) {
  const double angle = phi.norm();
  const double k = angle < 1e-8 ? 0.5 - angle * angle / 48 : std::sin(0.5 * angle) / angle;
  return Quaterniond(std::cos(0.5 * angle), k * phi.x(), k * phi.y(), k * phi.z());
}

}  // namespace waverig
