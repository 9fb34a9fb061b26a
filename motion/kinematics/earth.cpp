#include "motion/kinematics/earth.h"

#include "lcmtypes/error.h"

namespace waverig {
namespace {

struct Radii {
  double meridian_m, prime_vertical_m;
};

Radii radii_of_curvature(double latitude_rad, const EarthConstants& earth) {
  const double e2 = earth.flattening * (2 - earth.flattening);
  const double s = std::sin(latitude_rad);
  const double w2 = 1 - e2 * s * s;
  const double prime_vertical = earth.equatorial_radius_m / std::sqrt(w2);
  return {prime_vertical * (1 - e2) / w2, prime_vertical};
}

Vector3d earth_rate_N(double latitude_rad, const EarthConstants& earth) {
  return earth.rate_radps * Vector3d(std::cos(latitude_rad), 0, -std::sin(latitude_rad));
}

}  // namespace

Matrix3d R_NE(const Place& place) {
  const double sp = std::sin(place.latitude_rad), cp = std::cos(place.latitude_rad);
  const double sl = std::sin(place.longitude_rad), cl = std::cos(place.longitude_rad);
  Matrix3d R;
  R << -sp * cl, -sp * sl, cp,  //
      -sl, cl, 0,               //
      -cp * cl, -cp * sl, -sp;
  return R;
}

Vector3d position_E(const Place& place, const EarthConstants& earth) {
  const double n = radii_of_curvature(place.latitude_rad, earth).prime_vertical_m;
  const double e2 = earth.flattening * (2 - earth.flattening);
  const double cp = std::cos(place.latitude_rad);
  return {(n + place.height_m) * cp * std::cos(place.longitude_rad),
          (n + place.height_m) * cp * std::sin(place.longitude_rad),
          (n * (1 - e2) + place.height_m) * std::sin(place.latitude_rad)};
}

double gravitational_potential_m2ps2(const Vector3d& r_E, const EarthConstants& earth) {
  const double r = r_E.norm();
  const double s = r_E.z() / r, s2 = s * s;
  const double k2 = earth.equatorial_radius_m * earth.equatorial_radius_m / (r * r);
  const double P2 = 0.5 * (3 * s2 - 1), P4 = 0.125 * (35 * s2 * s2 - 30 * s2 + 3);  // eq. (8)
  return -earth.mu_m3ps2 / r * (1 - earth.J2 * k2 * P2 - earth.J4 * k2 * k2 * P4);  // eq. (7)
}

Vector3d gravitation_E(const Vector3d& r_E, const EarthConstants& earth) {
  const double r = r_E.norm();
  const double s = r_E.z() / r, s2 = s * s, s4 = s2 * s2;
  const double k2 = earth.equatorial_radius_m * earth.equatorial_radius_m / (r * r);
  const double c2 = 1.5 * earth.J2 * k2, c4 = 0.625 * earth.J4 * k2 * k2;
  const double xy = 1 - c2 * (5 * s2 - 1) - c4 * (63 * s4 - 42 * s2 + 3);
  const double z = 1 - c2 * (5 * s2 - 3) - c4 * (63 * s4 - 70 * s2 + 15);
  return -earth.mu_m3ps2 / (r * r * r) * Vector3d(xy * r_E.x(), xy * r_E.y(), z * r_E.z());  // eq. (9)
}

Vector3d gravity_E(const Vector3d& r_E, const EarthConstants& earth) {
  const double w2 =
      earth.rate_radps * earth.rate_radps;  // w_ie along z: -w x (w x R) points away from the axis
  return gravitation_E(r_E, earth) + w2 * Vector3d(r_E.x(), r_E.y(), 0);
}

Vector3d gravity_N(const Place& place, const EarthConstants& earth) {
  return R_NE(place) * gravity_E(position_E(place, earth), earth);
}

double gravity_mps2(const Place& place, const EarthConstants& earth) {
  return gravity_E(position_E(place, earth), earth).norm();
}

LocalEarth local_earth(const Place& place, const EarthConstants& earth) {
  constexpr double kClosestToPole_rad = 1.6e-7;  // 1 m
  if (!(std::abs(place.latitude_rad) <= std::numbers::pi / 2 - kClosestToPole_rad))
    throw UserError("latitude " + std::to_string(place.latitude_rad / kDegree) +
                    " deg: expected a place between the poles, where north and east are defined");
  const Radii radii = radii_of_curvature(place.latitude_rad, earth);
  return {gravity_N(place, earth), earth_rate_N(place.latitude_rad, earth), radii.meridian_m + place.height_m,
          radii.prime_vertical_m + place.height_m, std::tan(place.latitude_rad)};
}

Vector3d transport_rate_N(const LocalEarth& local, const Vector3d& v_N) {
  const double east = v_N.y() / local.east_radius_m;
  return {east, -v_N.x() / local.north_radius_m, -east * local.tan_latitude};
}

Vector3d velocity_rate_N(const LocalEarth& local, const Vector3d& f_N, const Vector3d& v_N) {
  const Vector3d w_N = 2 * local.w_ie_N + transport_rate_N(local, v_N);
  return f_N - w_N.cross(v_N) + local.g_N;
}

Vector3d specific_force_B(const BodyMotion& motion, const LocalEarth& local) {
  const Vector3d w_N = 2 * local.w_ie_N + transport_rate_N(local, motion.velocity_N);
  return motion.q_NB.conjugate() * (motion.acceleration_N + w_N.cross(motion.velocity_N) - local.g_N);
}

Vector3d inertial_rate_B(const BodyMotion& motion, const LocalEarth& local) {
  return motion.w_NB_B +
         motion.q_NB.conjugate() * (local.w_ie_N + transport_rate_N(local, motion.velocity_N));
}

}  // namespace waverig
