#include "estimator/compass/error_propagation.h"

#include <gtest/gtest.h>

#include <functional>

#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kG = kStandardGravity;
constexpr double kDip = 50 * kDegree;

struct Case {
  double heading_rad;
  Tilt tilt;
  Vector3d triad, m_B;
};

Case make_case(double heading_rad, const Tilt& tilt, double dip_rad = kDip) {
  const double cp = std::cos(tilt.pitch_rad);
  return {heading_rad, tilt,
          kG * Vector3d(std::sin(tilt.pitch_rad), std::sin(tilt.roll_rad) * cp, std::cos(tilt.roll_rad) * cp),
          field_B(heading_rad, dip_rad, tilt)};
}

Case random_case(RandomStream& random) {
  return make_case(random.uniform(-3.1, 3.1), {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)},
                   random.uniform(-1.2, 1.2));
}

// Central differences of fourth order.
double slope(const std::function<double(double)>& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

TEST(ErrorPropagation, TiltErrorIsTheNumericDerivative) {
  RandomStream random(1, "propagation");
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(random);
    const Vector3d d(random.gaussian(), random.gaussian(), random.gaussian());
    const TiltError linear = linear_tilt_error(c.triad, d);
    const double roll = slope([&](double h) { return tilt_of(c.triad + h * d).roll_rad; }, 1e-3);
    const double pitch = slope([&](double h) { return tilt_of(c.triad + h * d).pitch_rad; }, 1e-3);
    EXPECT_NEAR(linear.roll_rad, roll, 1e-8 * (1 + std::abs(roll)));
    EXPECT_NEAR(linear.pitch_rad, pitch, 1e-8 * (1 + std::abs(pitch)));
  }
}

// Equations (28) and (32) as the document prints them.
TEST(ErrorPropagation, TiltErrorIsThePrintedFormula) {
  RandomStream random(2, "propagation");
  for (int i = 0; i < 100; ++i) {
    const Case c = random_case(random);
    const Vector3d d(random.gaussian(), random.gaussian(), random.gaussian());
    const double sr = std::sin(c.tilt.roll_rad), cr = std::cos(c.tilt.roll_rad);
    const double sp = std::sin(c.tilt.pitch_rad), cp = std::cos(c.tilt.pitch_rad);
    const double ay = c.triad.y(), az = c.triad.z(), h = std::hypot(ay, az);
    const TiltError linear = linear_tilt_error(c.triad, d);
    EXPECT_NEAR(linear.roll_rad, cr * cr / az * d.y() - sr * cr / az * d.z(), 1e-13);
    EXPECT_NEAR(linear.pitch_rad,
                cp * cp / h * d.x() - ay * sp * cp / (h * h) * d.y() - az * sp * cp / (h * h) * d.z(), 1e-13);
  }
}

TEST(ErrorPropagation, HeadingGainIsTheNumericDerivative) {
  RandomStream random(3, "propagation");
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(random);
    const HeadingGain gain = heading_gain(c.m_B, c.tilt);
    const auto heading_off = [&](double roll, double pitch) {
      const double seen = heading_rad(c.m_B, {c.tilt.roll_rad + roll, c.tilt.pitch_rad + pitch});
      return std::remainder(seen - c.heading_rad, 2 * std::numbers::pi);
    };
    EXPECT_NEAR(gain.by_roll, slope([&](double h) { return heading_off(h, 0); }, 1e-4), 1e-8);
    EXPECT_NEAR(gain.by_pitch, slope([&](double h) { return heading_off(0, h); }, 1e-4), 1e-8);
  }
}

// Equations (39) and (40) as the document prints them, away from +-90 deg where tan psi has no value.
TEST(ErrorPropagation, HeadingGainIsThePrintedFormula) {
  RandomStream random(4, "propagation");
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(random);
    const double psi = c.heading_rad;
    if (std::abs(std::cos(psi)) < 0.05) continue;
    const double sr = std::sin(c.tilt.roll_rad), cr = std::cos(c.tilt.roll_rad);
    const double sp = std::sin(c.tilt.pitch_rad), cp = std::cos(c.tilt.pitch_rad);
    const double x = c.m_B.x(), y = c.m_B.y(), z = c.m_B.z(), t = std::tan(psi);
    const double D = x * cp + y * sr * sp + z * cr * sp;
    const double A = (y * (sr - cr * sp * t) + z * (cr + sr * sp * t)) / (D * (1 + t * t));
    const double B = (x * sp - y * sr * cp - z * cr * cp) * std::sin(psi) * std::cos(psi) / D;
    const HeadingGain gain = heading_gain(c.m_B, c.tilt);
    EXPECT_NEAR(gain.by_roll, A, 1e-9);
    EXPECT_NEAR(gain.by_pitch, B, 1e-9);
  }
}

TEST(ErrorPropagation, HeadingGainHasAClosedFormInHeadingAndDip) {
  RandomStream random(5, "propagation");
  for (int i = 0; i < 100; ++i) {
    const double dip = random.uniform(-1.2, 1.2), psi = random.uniform(-3.1, 3.1);
    const Tilt tilt{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
    const HeadingGain gain = heading_gain(field_B(psi, dip, tilt), tilt);
    EXPECT_NEAR(gain.by_roll,
                std::sin(tilt.pitch_rad) + std::tan(dip) * std::cos(tilt.pitch_rad) * std::cos(psi), 1e-12);
    EXPECT_NEAR(gain.by_pitch, -std::tan(dip) * std::sin(psi), 1e-12);
  }
}

TEST(ErrorPropagation, HoldsWhereThePrintedTangentHasNoValue) {
  const Tilt tilt{0.3, -0.2};
  const HeadingGain gain = heading_gain(field_B(std::numbers::pi / 2, kDip, tilt), tilt);
  EXPECT_NEAR(gain.by_pitch, -std::tan(kDip), 1e-12);
  EXPECT_NEAR(gain.by_roll, std::sin(tilt.pitch_rad), 1e-12);
}

TEST(ErrorPropagation, SecondOrderIsTheNumericCurvature) {
  RandomStream random(6, "propagation");
  for (int i = 0; i < 100; ++i) {
    const Case c = random_case(random);
    const Vector3d d = Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
    const Expansions e = expand(c.triad, c.m_B);
    const double h = 0.01;
    const Vector3d curvature =
        (exact_error_rad(c.triad, c.m_B, h * d) + exact_error_rad(c.triad, c.m_B, -h * d)) / (h * h);
    const Vector3d expected(d.dot(e.roll.hessian * d), d.dot(e.pitch.hessian * d),
                            d.dot(e.heading.hessian * d));
    EXPECT_LT((curvature - expected).norm(), 2e-4 * (0.1 + expected.norm()));
  }
}

TEST(ErrorPropagation, EachOrderMissesByOnePowerMoreOfTheError) {
  RandomStream random(7, "propagation");
  for (int i = 0; i < 50; ++i) {
    const Case c = random_case(random);
    const Vector3d d = Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
    const Expansions e = expand(c.triad, c.m_B);
    const auto miss = [&](double h, bool second) {
      const Vector3d step = h * d;
      const double exact_heading = exact_error_rad(c.triad, c.m_B, step).z();
      return std::abs(exact_heading - (second ? e.heading.second(step) : e.heading.first(step)));
    };
    EXPECT_LT(miss(0.005, false), 0.3 * miss(0.01, false) + 1e-9);
    EXPECT_LT(miss(0.005, true), 0.16 * miss(0.01, true) + 1e-9);
  }
}

TEST(ErrorFigures, ExactOnesAgreeWithMonteCarlo) {
  const Case c = make_case(45 * kDegree, {50 * kDegree, 50 * kDegree});
  RandomStream random(8, "propagation");
  for (const double sigma : {0.1, 1.0}) {
    const ExactFigures figures = exact(c.triad, c.m_B, sigma, Angle::kHeading);
    const Expansions e = expand(c.triad, c.m_B);
    const int n = 200000;
    double sum = 0, square = 0, miss = 0;
    for (int i = 0; i < n; ++i) {
      const Vector3d d(random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma));
      const double error = exact_error_rad(c.triad, c.m_B, d).z();
      sum += error;
      square += error * error;
      miss += std::pow(error - e.heading.first(d), 2);
    }
    const double mean = sum / n, std = std::sqrt(square / n - mean * mean);
    EXPECT_NEAR(figures.error.mean_rad, mean, 4 * std / std::sqrt(n));
    EXPECT_NEAR(figures.error.std_rad, std, 0.01 * std);
    EXPECT_NEAR(figures.first_order_miss_rad, std::sqrt(miss / n), 0.03 * figures.first_order_miss_rad);
  }
}

TEST(ErrorFigures, FirstOrderIsRightForSmallAndWrongForLargeErrors) {
  const Case c = make_case(45 * kDegree, {50 * kDegree, 50 * kDegree});
  const Expansions e = expand(c.triad, c.m_B);
  for (const Angle angle : {Angle::kRoll, Angle::kPitch, Angle::kHeading}) {
    const Expansion& of = angle == Angle::kRoll ? e.roll : angle == Angle::kPitch ? e.pitch : e.heading;
    const ErrorFigure small = exact(c.triad, c.m_B, 0.01, angle).error;
    EXPECT_NEAR(first_order(of, 0.01).std_rad, small.std_rad, 1e-4 * small.std_rad);
    const ErrorFigure large = exact(c.triad, c.m_B, 1.0, angle).error;
    const double first = std::abs(first_order(of, 1.0).std_rad - large.std_rad);
    EXPECT_GT(first, 1e-3 * large.std_rad);
    if (angle == Angle::kPitch) {  // its mean is second order: the linear formula knows none
      EXPECT_GT(std::abs(large.mean_rad), 0.2 * kDegree);
      EXPECT_NEAR(second_order(of, 1.0).mean_rad, large.mean_rad, 0.1 * std::abs(large.mean_rad));
    }
  }
}

TEST(ErrorFigures, TheAdequateOneIsWithinItsToleranceEverywhere) {
  RandomStream random(9, "propagation");
  int orders[4] = {0, 0, 0, 0};
  for (int i = 0; i < 60; ++i) {
    const Case c =
        make_case(random.uniform(-3.1, 3.1), {random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9)});
    const double sigma = std::pow(10, random.uniform(-2, 0.1));
    const AdequateFigure figure = adequate(c.triad, c.m_B, sigma, Angle::kHeading);
    const ErrorFigure truth = exact(c.triad, c.m_B, sigma, Angle::kHeading).error;
    EXPECT_NEAR(figure.error.std_rad, truth.std_rad, 0.1 * truth.std_rad);
    ++orders[static_cast<int>(figure.order)];
  }
  EXPECT_GT(orders[1], 5);
  EXPECT_GT(orders[2], 5);
}

TEST(Border, LiesWhereTheLinearFormulaMissesATenth) {
  const double border = border_of_g({0.5, 0.5}, 45 * kDegree, kDip, Angle::kHeading, Order::kFirst);
  const Case c = make_case(45 * kDegree, {0.5, 0.5});
  const ExactFigures figures = exact(c.triad, c.m_B, border * kG, Angle::kHeading);
  EXPECT_NEAR(figures.first_order_miss_rad, 0.1 * std::hypot(figures.error.mean_rad, figures.error.std_rad),
              0.002 * figures.error.std_rad);
}

TEST(Border, ClosesInWithTheTiltAndTheSecondOrderReachesFurther) {
  double previous = 1;
  for (const double tilt_deg : {0.0, 30.0, 50.0, 70.0}) {
    const Tilt tilt{tilt_deg * kDegree, 0};
    const double first = border_of_g(tilt, 45 * kDegree, kDip, Angle::kRoll, Order::kFirst);
    const double second = border_of_g(tilt, 45 * kDegree, kDip, Angle::kRoll, Order::kSecond);
    EXPECT_LE(first, previous + 1e-3);
    EXPECT_GT(second, 1.5 * first);
    previous = first;
  }
}

}  // namespace
}  // namespace waverig::estimator
