// Earth, after Lee-HK: gravitation with J2 and J4, gravity at a place, Earth rate, the velocity equation in
// NED. Frames: E is Earth-centred Earth-fixed (z to the north pole, x to the zero meridian), N is north,
// east, down at the place, normal to the ellipsoid. Metres, seconds, radians.
#pragma once
#include "motion/kinematics/body_motion.h"
#include "motion/kinematics/frames.h"

namespace waverig {

struct EarthConstants {
  double mu_m3ps2 = 0;             // G times the Earth's mass
  double equatorial_radius_m = 0;  // a
  double flattening = 0;           // of the ellipsoid that latitude and height refer to
  double J2 = 0, J4 = 0;           // zonal coefficients of the potential, eq. (7)
  double rate_radps = 0;           // w_ie
};

// WGS-84 with the zonal coefficients of the true Earth; within 4e-5 m/s^2 of the normal (Somigliana) gravity.
inline constexpr EarthConstants kWgs84{3.986004418e14, 6378137.0, 1 / 298.257223563,
                                       1082.63e-6,     -1.62e-6,  7.292115e-5};
// The document's: G * Me = 6.67428e-11 * 5.9742e24 is 0.034 % high and gives 9.8095 m/s^2 at 45 deg.
inline constexpr EarthConstants kLeeHk{
    6.67428e-11 * 5.9742e24, 6378137.0, 1 / 298.257223563, 1082.63e-6, -1.60e-6, 7.292115e-5};

// Geodetic latitude and height above the ellipsoid.
struct Place {
  double latitude_rad = 0;
  double longitude_rad = 0;
  double height_m = 0;
};

Matrix3d R_NE(const Place& place);
Vector3d position_E(const Place& place, const EarthConstants& earth = kWgs84);

// Potential U in m^2/s^2, Lee-HK, eq. (7) up to n = 4, and its gradient Gamma = -grad U in m/s^2, eq. (9)
// with the sign of eq. (6). r_E must not be zero.
double gravitational_potential_m2ps2(const Vector3d& r_E, const EarthConstants& earth = kWgs84);
Vector3d gravitation_E(const Vector3d& r_E, const EarthConstants& earth = kWgs84);

// g = Gamma - w_ie x (w_ie x R), Lee-HK, eq. (25).
Vector3d gravity_E(const Vector3d& r_E, const EarthConstants& earth = kWgs84);
Vector3d gravity_N(const Place& place, const EarthConstants& earth = kWgs84);
double gravity_mps2(const Place& place,
                    const EarthConstants& earth = kWgs84);  // the norm: what calibration uses

// What a model near one place needs, computed once: everything within kilometres of it (and of N's axes)
// shares it.
struct LocalEarth {
  Vector3d g_N = Vector3d::Zero();  // m/s^2; its horizontal part is the plumb line's deflection with height
  Vector3d w_ie_N = Vector3d::Zero();  // rad/s
  double north_radius_m = 0;           // meridian radius of curvature + height
  double east_radius_m = 0;            // prime-vertical radius + height
  double tan_latitude = 0;
};

// At a pole the transport rate about the vertical is singular: throws UserError within 1 m of it.
LocalEarth local_earth(const Place& place, const EarthConstants& earth = kWgs84);

// w_en^n: how N turns against E while it is carried along with v_N (m/s).
Vector3d transport_rate_N(const LocalEarth& local, const Vector3d& v_N);

// dV^n/dt = f^n - (2 w_ie^n + w_en^n) x V^n + g^n, Lee-HK, eq. (28).
Vector3d velocity_rate_N(const LocalEarth& local, const Vector3d& f_N, const Vector3d& v_N);

// What ideal inertial sensors feel on the turning Earth: eq. (28) solved for f, and w_ib^b = w_nb^b + w_ie^b
// + w_en^b.
Vector3d specific_force_B(const BodyMotion& motion, const LocalEarth& local);
Vector3d inertial_rate_B(const BodyMotion& motion, const LocalEarth& local);

}  // namespace waverig
