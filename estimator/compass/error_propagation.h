// How accelerometer errors become roll, pitch and heading errors: Cho, eqs. (28)-(40), their second order,
// and the exact figure where neither is good enough. triad as in heading.h (m/s^2), m_B normalised, errors as
// measured - true.
#pragma once
#include "estimator/compass/heading.h"

namespace waverig::estimator {

struct TiltError {
  double roll_rad = 0, pitch_rad = 0;
};

// Cho, eqs. (28) and (32), written without the division by az: az = h cos ph.
TiltError linear_tilt_error(const Vector3d& triad, const Vector3d& d_triad);

// A and B of Cho, eq. (38): d_psi = A d_ph + B d_th.
struct HeadingGain {
  double by_roll = 0, by_pitch = 0;
};

// Cho, eqs. (39) and (40) with tan psi = N / D cleared, so that they hold at +-90 deg too, where the printed
// ones are 0 / 0. With a noiseless field A = sin th + tan lam cos th cos psi and B = -tan lam sin psi.
HeadingGain heading_gain(const Vector3d& m_B, const Tilt& tilt);

// An angle's Taylor expansion in the triad's errors.
struct Expansion {
  Vector3d gradient = Vector3d::Zero();  // rad per m/s^2
  Matrix3d hessian = Matrix3d::Zero();   // rad per (m/s^2)^2

  double first(const Vector3d& d) const { return gradient.dot(d); }
  double second(const Vector3d& d) const { return first(d) + 0.5 * d.dot(hessian * d); }
};

struct Expansions {
  Expansion roll, pitch, heading;
};

// triad and m_B must be off the singularities: hypot(ay, az) > 0, a horizontal field.
Expansions expand(const Vector3d& triad, const Vector3d& m_B);

// Exact error of roll, pitch and heading for one error of the triad, in (-pi, pi].
Vector3d exact_error_rad(const Vector3d& triad, const Vector3d& m_B, const Vector3d& d_triad);

// Mean and standard deviation of an angle's error under independent normal errors of standard deviation
// sigma_mps2 per axis.
struct ErrorFigure {
  double mean_rad = 0, std_rad = 0;
};

ErrorFigure first_order(const Expansion& expansion, double sigma_mps2);
ErrorFigure second_order(const Expansion& expansion, double sigma_mps2);

// By Gauss-Hermite quadrature over the three axes: the exact figures, and the root-mean-square error of what
// first and second order predict of the single error.
struct ExactFigures {
  ErrorFigure error;
  double first_order_miss_rad = 0;
  double second_order_miss_rad = 0;
};
enum class Angle { kRoll = 0, kPitch = 1, kHeading = 2 };
ExactFigures exact(const Vector3d& triad, const Vector3d& m_B, double sigma_mps2, Angle angle);

// The figure by the cheapest order that is good enough: a formula is used where the next order's contribution
// stays below `tolerance` of the figure.
enum class Order { kFirst = 1, kSecond = 2, kExact = 3 };
struct AdequateFigure {
  ErrorFigure error;
  Order order = Order::kFirst;
};
AdequateFigure adequate(const Vector3d& triad, const Vector3d& m_B, double sigma_mps2, Angle angle,
                        double tolerance = 0.1);

// The border: the accelerometer error, as a fraction of g, at which the single error predicted by that order
// (first or second) misses by `tolerance` of the error itself (root mean squares). At most 0.5.
double border_of_g(const Tilt& tilt, double heading_rad, double dip_rad, Angle angle, Order order,
                   double tolerance = 0.1);

}  // namespace waverig::estimator
