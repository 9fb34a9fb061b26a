// Heading from a calibrated magnetometer and the tilt, after Cho: three axes, or two with the third
// reconstructed. Fields are normalised: m_B has length 1. Angles in radians; headings clockwise from magnetic
// north, in (-pi, pi].
#pragma once
#include "motion/kinematics/frames.h"

namespace waverig::estimator {

struct Tilt {
  double roll_rad = 0, pitch_rad = 0;
};

// Cho's accelerometer triad g (sin th, sin ph cos th, cos ph cos th) from specific force at rest: the sign of
// y and z is turned, because f = -g R_BN (0, 0, 1) = g (sin th, -sin ph cos th, -cos ph cos th).
inline Vector3d triad_of(const Vector3d& f_B) { return {f_B.x(), -f_B.y(), -f_B.z()}; }

// Cho, eqs. (17) and (19); the triad may have any length but zero.
Tilt tilt_of(const Vector3d& triad);

// The levelled field, Cho, eq. (12): (cos psi cos lam, -sin psi cos lam, sin lam).
Vector3d levelled_field(const Vector3d& m_B, const Tilt& tilt);

// The field that eq. (12) inverts: what a perfect magnetometer shows, normalised.
Vector3d field_B(double heading_rad, double dip_rad, const Tilt& tilt);

double heading_rad(const Vector3d& m_B, const Tilt& tilt);  // Cho, eq. (14)
inline double level_heading_rad(double x, double y) {
  return std::atan2(-y, x);
}  // Cho, eq. (20), whole circle
double dip_rad(const Vector3d& m_B, const Tilt& tilt);  // from the third row of eq. (12)

// Dip from the two horizontal axes of a level sensor, Cho, eq. (25). Noise that lifts hypot(x, y) above 1
// gives 0.
double level_dip_rad(double x, double y);

// Declination applied once, at the door out: magnetic to true, in (-pi, pi].
double true_heading_rad(double magnetic_heading_rad, double declination_rad);

// How well the inputs of the two-axis module are known; standard uncertainties.
struct TwoAxisSettings {
  double tilt_sigma_rad = 0;
  double dip_sigma_rad = 0;
  double field_sigma = 0;  // of x and y, of the normalised field
  double guard = 2;        // the sign is doubtful within so many standard uncertainties of zero
};

struct ReconstructedZ {
  double z = 0;                // Cho, eq. (24)
  double z_by_tilt = 0;        // Cho, eq. (23): its sign decides
  double sigma_by_tilt = 0;    // of z_by_tilt
  bool sign_doubtful = false;  // z_by_tilt is too near zero to decide: z may have either sign
  bool beyond_unit = false;    // x^2 + y^2 > 1: noise or a bad calibration; z is set to zero
};

// Roll and pitch must stay below 90 deg.
ReconstructedZ reconstruct_z(double x, double y, const Tilt& tilt, double dip_rad,
                             const TwoAxisSettings& settings);

struct TwoAxisHeading {
  double heading_rad = 0;
  double other_heading_rad = 0;  // with the other sign of z: how much is at stake where the sign is doubtful
  ReconstructedZ z;
};

TwoAxisHeading two_axis_heading(double x, double y, const Tilt& tilt, double dip_rad,
                                const TwoAxisSettings& settings);

}  // namespace waverig::estimator
