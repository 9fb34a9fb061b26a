#include "rig/sensors/magnetometer.h"

#include <algorithm>
#include <cmath>

namespace waverig::rig {
namespace {

constexpr double kUnquantisedCount_uT = 1e-3;
constexpr double kNearestToMotor_m = 0.01;

// B = mu0 / (4 pi r^3) (3 (m . r^) r^ - m); mu0 / 4 pi = 0.1 uT m / A.
Vector3d dipole_uT(const Vector3d& moment_Am2, const Vector3d& r_m) {
  const double r = r_m.norm();
  const Vector3d unit = r_m / r;
  return 0.1 / (r * r * r) * (3 * moment_Am2.dot(unit) * unit - moment_Am2);
}

}  // namespace

Vector3d earth_field_N_uT(const EarthFieldSettings& s) {
  const double level = s.total_uT * std::cos(s.dip_rad);
  return {level * std::cos(s.declination_rad), level * std::sin(s.declination_rad),
          s.total_uT * std::sin(s.dip_rad)};
}

Vector3d motor_field_N_uT(const MotorFieldSettings& s, const Vector3d& position_N_m) {
  const Vector3d r = position_N_m - s.hub_N_m;
  if (r.norm() < kNearestToMotor_m) return Vector3d::Zero();
  Vector3d moment = s.stator_moment_N_Am2;
  if (!s.rotor_moment_Am2.isZero(0)) {
    const Vector3d axis(-std::sin(s.azimuth_rad), std::cos(s.azimuth_rad), 0);
    const Vector3d in_plane = r - r.dot(axis) * axis;
    if (in_plane.norm() < kNearestToMotor_m) return dipole_uT(moment, r);
    const Vector3d along = in_plane.normalized();
    moment += s.rotor_moment_Am2.x() * along + s.rotor_moment_Am2.y() * axis.cross(along) +
              s.rotor_moment_Am2.z() * axis;
  }
  return dipole_uT(moment, r);
}

MagnetometerSettings mag3110() {
  MagnetometerSettings s;
  s.lsb_uT = 0.1;
  s.largest_count = 10000;
  s.noise_uT = 0.25;
  s.output_rate_Hz = 80;
  s.hard_iron_sigma_uT = 15;
  s.scale_sigma = 0.03;
  s.soft_iron_sigma = 0.02;
  return s;
}

MagnetometerSettings hmc5883l() {
  MagnetometerSettings s = mag3110();
  s.lsb_uT = 100.0 / 1090;
  s.largest_count = 2047;
  s.overflow_count = -4096;
  s.noise_uT = 0.2;
  s.output_rate_Hz = 75;
  return s;
}

double magnetometer_count_uT(const MagnetometerSettings& settings) {
  return settings.lsb_uT > 0 ? settings.lsb_uT : kUnquantisedCount_uT;
}

MagnetometerParameters draw_magnetometer(const MagnetometerSettings& s, std::uint64_t seed) {
  RandomStream random(seed, "magnetometer unit");
  MagnetometerParameters unit;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col)
      unit.soft_iron(row, col) += random.gaussian(row == col ? s.scale_sigma : s.soft_iron_sigma);
  for (int i = 0; i < 3; ++i) unit.hard_iron_uT[i] = random.gaussian(s.hard_iron_sigma_uT);
  return unit;
}

Magnetometer::Magnetometer(const MagnetometerSettings& settings, const MagnetometerParameters& unit,
                           std::uint64_t noise_seed)
    : settings_(settings),
      unit_(unit),
      earth_N_uT_(earth_field_N_uT(settings.earth)),
      counts_per_uT_(1 / magnetometer_count_uT(settings)),
      noise_stream_(noise_seed, "magnetometer noise"),
      interval_us_(settings.output_rate_Hz > 0 ? std::llround(1e6 / settings.output_rate_Hz) : 0) {}

Eigen::Vector3i Magnetometer::sample(const BodyMotion& motion) {
  if (!started_) next_utime_ = motion.utime;
  started_ = true;
  if (motion.utime >= next_utime_) {  // 6
    convert(motion);
    next_utime_ = std::max(next_utime_ + interval_us_, motion.utime - interval_us_);
  }
  return counts_;
}

void Magnetometer::convert(const BodyMotion& motion) {
  const Vector3d field_N = earth_N_uT_ + motor_field_N_uT(settings_.motor, motion.position_N);  // 1, 2
  Vector3d field = unit_.soft_iron * (motion.q_NB.conjugate() * field_N) + unit_.hard_iron_uT;  // 3
  if (settings_.noise_uT > 0)                                                                   // 4
    for (int i = 0; i < 3; ++i) field[i] += noise_stream_.gaussian(settings_.noise_uT);
  saturated_ = false;
  for (int i = 0; i < 3; ++i) {  // 5
    double count = std::nearbyint(field[i] * counts_per_uT_);
    const double limit = settings_.largest_count > 0 ? settings_.largest_count : 2.0e9;
    if (std::abs(count) > limit) {
      saturated_ = true;
      count = settings_.overflow_count != 0 ? settings_.overflow_count : std::copysign(limit, count);
    }
    counts_[i] = static_cast<std::int32_t>(count);
  }
}

}  // namespace waverig::rig
