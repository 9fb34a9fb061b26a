#include "estimator/compass/heading.h"

namespace waverig::estimator {

Tilt tilt_of(const Vector3d& triad) {
  return {std::atan2(triad.y(), triad.z()), std::atan2(triad.x(), std::hypot(triad.y(), triad.z()))};
}

Vector3d levelled_field(const Vector3d& m_B, const Tilt& tilt) {
  const double sr = std::sin(tilt.roll_rad), cr = std::cos(tilt.roll_rad);
  const double sp = std::sin(tilt.pitch_rad), cp = std::cos(tilt.pitch_rad);
  const double down = m_B.y() * sr + m_B.z() * cr;  // after the roll is undone
  return {m_B.x() * cp + down * sp, m_B.y() * cr - m_B.z() * sr, -m_B.x() * sp + down * cp};
}

Vector3d field_B(double heading_rad, double dip_rad, const Tilt& tilt) {
  const Vector3d m_N(std::cos(dip_rad), 0, std::sin(dip_rad));
  return quaternion_of({tilt.roll_rad, tilt.pitch_rad, heading_rad}).conjugate() * m_N;
}

double heading_rad(const Vector3d& m_B, const Tilt& tilt) {
  const Vector3d level = levelled_field(m_B, tilt);
  return level_heading_rad(level.x(), level.y());
}

double dip_rad(const Vector3d& m_B, const Tilt& tilt) {
  const Vector3d level = levelled_field(m_B, tilt);
  return std::atan2(level.z(), std::hypot(level.x(), level.y()));
}

double level_dip_rad(double x, double y) { return std::acos(std::min(1.0, std::hypot(x, y))); }

double true_heading_rad(double magnetic_heading_rad, double declination_rad) {
  return std::remainder(magnetic_heading_rad + declination_rad, 2 * std::numbers::pi);
}

ReconstructedZ reconstruct_z(double x, double y, const Tilt& tilt, double dip_rad,
                             const TwoAxisSettings& settings) {
  const double sec_r = 1 / std::cos(tilt.roll_rad), tan_r = std::tan(tilt.roll_rad);
  const double sec_p = 1 / std::cos(tilt.pitch_rad), tan_p = std::tan(tilt.pitch_rad);
  const double sin_dip = std::sin(dip_rad);

  ReconstructedZ result;
  result.z_by_tilt = sec_r * sec_p * sin_dip + x * sec_r * tan_p - y * tan_r;  // eq. (23)

  const double by_roll = sec_r * tan_r * (sec_p * sin_dip + x * tan_p) - y * sec_r * sec_r;
  const double by_pitch = sec_r * sec_p * (tan_p * sin_dip + x * sec_p);
  const double by_dip = sec_r * sec_p * std::cos(dip_rad);
  result.sigma_by_tilt =
      std::hypot(std::hypot(by_roll, by_pitch) * settings.tilt_sigma_rad, by_dip * settings.dip_sigma_rad,
                 std::hypot(sec_r * tan_p, tan_r) * settings.field_sigma);
  result.sign_doubtful = std::abs(result.z_by_tilt) < settings.guard * result.sigma_by_tilt;

  const double square = 1 - x * x - y * y;
  result.beyond_unit = square < 0;
  result.z = std::copysign(std::sqrt(std::max(0.0, square)), result.z_by_tilt);  // eqs. (22), (24)
  return result;
}

TwoAxisHeading two_axis_heading(double x, double y, const Tilt& tilt, double dip_rad,
                                const TwoAxisSettings& settings) {
  TwoAxisHeading result;
  result.z = reconstruct_z(x, y, tilt, dip_rad, settings);
  result.heading_rad = heading_rad({x, y, result.z.z}, tilt);
  result.other_heading_rad = heading_rad({x, y, -result.z.z}, tilt);
  return result;
}

}  // namespace waverig::estimator
