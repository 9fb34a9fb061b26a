#include "estimator/compass/error_propagation.h"

#include <Eigen/Eigenvalues>
#include <complex>
#include <vector>

namespace waverig::estimator {
namespace {

using Complex = std::complex<double>;

// w = D + i N, Cho's numerator and denominator of eq. (14), with its derivatives: psi = arg w.
struct HeadingVector {
  Complex w, by_roll, by_pitch, by_roll2, by_roll_pitch, by_pitch2;
};

HeadingVector heading_vector(const Vector3d& m_B, const Tilt& tilt) {
  const double sr = std::sin(tilt.roll_rad), cr = std::cos(tilt.roll_rad);
  const double sp = std::sin(tilt.pitch_rad), cp = std::cos(tilt.pitch_rad);
  const double right = m_B.y() * cr - m_B.z() * sr, down = m_B.y() * sr + m_B.z() * cr;  // roll undone
  const double ahead = m_B.x() * cp + down * sp, below = -m_B.x() * sp + down * cp;      // pitch undone
  return {.w = {ahead, -right},
          .by_roll = {right * sp, down},  // d down / d ph = right, d right / d ph = -down
          .by_pitch = {below, 0},
          .by_roll2 = {-down * sp, right},
          .by_roll_pitch = {right * cp, 0},
          .by_pitch2 = {-ahead, 0}};
}

// Second derivatives of arg w = Im log w.
double second_derivative(Complex w, Complex a, Complex b, Complex ab) {
  return std::imag(ab / w - a * b / (w * w));
}

Expansion expand_roll(const Vector3d& t) {
  const double y = t.y(), z = t.z(), h2 = y * y + z * z, h4 = h2 * h2;
  Expansion e;
  e.gradient = Vector3d(0, z, -y) / h2;
  e.hessian(1, 1) = -2 * y * z / h4;
  e.hessian(2, 2) = 2 * y * z / h4;
  e.hessian(1, 2) = e.hessian(2, 1) = (y * y - z * z) / h4;
  return e;
}

Expansion expand_pitch(const Vector3d& t) {
  const double x = t.x(), y = t.y(), z = t.z(), h = std::hypot(y, z);
  const double g2 = x * x + h * h, g4 = g2 * g2;
  const Vector3d dx(1, 0, 0), dh(0, y / h, z / h);
  Matrix3d ddh = Matrix3d::Zero();
  ddh(1, 1) = z * z;
  ddh(2, 2) = y * y;
  ddh(1, 2) = ddh(2, 1) = -y * z;
  ddh /= h * h * h;
  const double by_x = h / g2, by_h = -x / g2;
  const double by_xx = -2 * x * h / g4, by_hh = 2 * x * h / g4, by_xh = (x * x - h * h) / g4;
  Expansion e;
  e.gradient = by_x * dx + by_h * dh;
  e.hessian = by_xx * dx * dx.transpose() + by_hh * dh * dh.transpose() +
              by_xh * (dx * dh.transpose() + dh * dx.transpose()) + by_h * ddh;
  return e;
}

Expansion expand_heading(const Vector3d& m_B, const Tilt& tilt, const Expansion& roll,
                         const Expansion& pitch) {
  const HeadingVector v = heading_vector(m_B, tilt);
  const double by_r = std::imag(v.by_roll / v.w), by_p = std::imag(v.by_pitch / v.w);
  const double by_rr = second_derivative(v.w, v.by_roll, v.by_roll, v.by_roll2);
  const double by_rp = second_derivative(v.w, v.by_roll, v.by_pitch, v.by_roll_pitch);
  const double by_pp = second_derivative(v.w, v.by_pitch, v.by_pitch, v.by_pitch2);
  const Vector3d &r = roll.gradient, &p = pitch.gradient;
  Expansion e;
  e.gradient = by_r * r + by_p * p;
  e.hessian = by_rr * r * r.transpose() + by_rp * (r * p.transpose() + p * r.transpose()) +
              by_pp * p * p.transpose() + by_r * roll.hessian + by_p * pitch.hessian;
  return e;
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

const Expansion& of(const Expansions& expansions, Angle angle) {
  return angle == Angle::kRoll    ? expansions.roll
         : angle == Angle::kPitch ? expansions.pitch
                                  : expansions.heading;
}

// Root mean square of what the second order adds: its mean and its standard deviation.
double second_order_rms(const Expansion& e, double sigma) {
  const double mean = 0.5 * sigma * sigma * e.hessian.trace();
  return std::hypot(mean, sigma * sigma * std::sqrt(0.5) * e.hessian.norm());
}

// Nodes and weights for the normal distribution: eigenvalues of the Jacobi matrix (Golub & Welsch 1969).
constexpr double kNegligibleWeight = 1e-13;  // the corners of the cube: three quarters of the nodes
struct NormalQuadrature {
  static constexpr int kNodes = 24;
  Eigen::VectorXd node, weight;
  NormalQuadrature() {
    Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(kNodes, kNodes);
    for (int i = 1; i < kNodes; ++i) jacobi(i, i - 1) = jacobi(i - 1, i) = std::sqrt(static_cast<double>(i));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(jacobi);
    node = solver.eigenvalues();
    weight = solver.eigenvectors().row(0).array().square();
  }
};

}  // namespace

TiltError linear_tilt_error(const Vector3d& t, const Vector3d& d) {
  const double h2 = t.y() * t.y() + t.z() * t.z(), h = std::sqrt(h2), g2 = h2 + t.x() * t.x();
  const double roll = (t.z() * d.y() - t.y() * d.z()) / h2;                             // eq. (28)
  const double pitch = (h * d.x() - t.x() * (t.y() * d.y() + t.z() * d.z()) / h) / g2;  // eq. (32)
  return {roll, pitch};
}

HeadingGain heading_gain(const Vector3d& m_B, const Tilt& tilt) {
  const HeadingVector v = heading_vector(m_B, tilt);
  return {std::imag(v.by_roll / v.w), std::imag(v.by_pitch / v.w)};  // eqs. (39), (40)
}

Expansions expand(const Vector3d& triad, const Vector3d& m_B) {
  Expansions e;
  e.roll = expand_roll(triad);
  e.pitch = expand_pitch(triad);
  e.heading = expand_heading(m_B, tilt_of(triad), e.roll, e.pitch);
  return e;
}

Vector3d exact_error_rad(const Vector3d& triad, const Vector3d& m_B, const Vector3d& d_triad) {
  const Tilt is = tilt_of(triad), seen = tilt_of(triad + d_triad);
  return {wrapped(seen.roll_rad - is.roll_rad), wrapped(seen.pitch_rad - is.pitch_rad),
          wrapped(heading_rad(m_B, seen) - heading_rad(m_B, is))};
}

ErrorFigure first_order(const Expansion& e, double sigma) { return {0, sigma * e.gradient.norm()}; }

// For d ~ N(0, sigma^2 I): E[d'Hd / 2] = sigma^2 tr H / 2, Var[d'Hd / 2] = sigma^4 |H|^2 / 2, odd moments
// vanish.
ErrorFigure second_order(const Expansion& e, double sigma) {
  const double s2 = sigma * sigma;
  return {0.5 * s2 * e.hessian.trace(),
          std::hypot(sigma * e.gradient.norm(), s2 * std::sqrt(0.5) * e.hessian.norm())};
}

ExactFigures exact(const Vector3d& triad, const Vector3d& m_B, double sigma, Angle angle) {
  static const NormalQuadrature kQuadrature;
  const Expansions expansions = expand(triad, m_B);
  const Expansion& expansion = of(expansions, angle);
  double mean = 0, square = 0, first = 0, second = 0;
  for (int i = 0; i < NormalQuadrature::kNodes; ++i)
    for (int j = 0; j < NormalQuadrature::kNodes; ++j)
      for (int k = 0; k < NormalQuadrature::kNodes; ++k) {
        const Vector3d d = sigma * Vector3d(kQuadrature.node[i], kQuadrature.node[j], kQuadrature.node[k]);
        const double weight = kQuadrature.weight[i] * kQuadrature.weight[j] * kQuadrature.weight[k];
        if (weight < kNegligibleWeight) continue;
        const double error = exact_error_rad(triad, m_B, d)[static_cast<int>(angle)];
        mean += weight * error;
        square += weight * error * error;
        first += weight * std::pow(error - expansion.first(d), 2);
        second += weight * std::pow(error - expansion.second(d), 2);
      }
  return {{mean, std::sqrt(std::max(0.0, square - mean * mean))}, std::sqrt(first), std::sqrt(second)};
}

AdequateFigure adequate(const Vector3d& triad, const Vector3d& m_B, double sigma, Angle angle,
                        double tolerance) {
  const Expansions expansions = expand(triad, m_B);
  const Expansion& e = of(expansions, angle);
  const double first = first_order(e, sigma).std_rad;
  // Each order is smaller than the one before by about the same ratio: the third is the second's ratio once
  // more.
  const double ratio = second_order_rms(e, sigma) / std::max(first, 1e-300);
  if (ratio < tolerance) return {first_order(e, sigma), Order::kFirst};
  if (ratio * ratio < tolerance) return {second_order(e, sigma), Order::kSecond};
  return {exact(triad, m_B, sigma, angle).error, Order::kExact};
}

double border_of_g(const Tilt& tilt, double heading, double dip, Angle angle, Order order, double tolerance) {
  const double sp = std::sin(tilt.pitch_rad), cp = std::cos(tilt.pitch_rad);
  const Vector3d triad(sp, std::sin(tilt.roll_rad) * cp, std::cos(tilt.roll_rad) * cp);  // in units of g
  const Vector3d m_B = field_B(heading, dip, tilt);
  const auto good = [&](double sigma) {
    const ExactFigures figures = exact(triad, m_B, sigma, angle);
    const double miss = order == Order::kFirst ? figures.first_order_miss_rad : figures.second_order_miss_rad;
    return miss < tolerance * std::hypot(figures.error.mean_rad, figures.error.std_rad);
  };
  double low = 1e-4, high = 0.5;
  if (good(high)) return high;
  for (int i = 0; i < 20 && high > 1.005 * low; ++i) {  // bisection of the logarithm
    const double middle = std::sqrt(low * high);
    (good(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace waverig::estimator
