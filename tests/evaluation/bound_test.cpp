#include "estimator/evaluation/bound.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "motion/envelope.h"
#include "motion/kinematics/frames.h"
#include "motion/kinematics/random.h"

namespace waverig::evaluation {
namespace {

constexpr double kDensity = 350e-6 * kStandardGravity;  // MMA7331LC class, REFERENCE section 3

// REFERENCE section 3: 0.26 cm at 6 s and 0.72 cm at 12 s.
TEST(HeightBound, GivesThePublishedFigures) {
  EXPECT_NEAR(height_bound_m({6, kDensity, 100}), 0.0026, 0.00005);
  EXPECT_NEAR(height_bound_m({12, kDensity, 100}), 0.0072, 0.00005);
}

TEST(HeightBound, ApproachesTheClosedFormFromCrestToCrest) {
  for (const double period_s : {2.0, 6.0, 12.0, 20.0})
    EXPECT_NEAR(height_bound_m({period_s, kDensity, 100}) / motion::height_sigma_bound_m(period_s, kDensity), 1, 1e-9)
        << period_s;
}

TEST(HeightBound, GrowsWithThePeriodToThePowerTwoAndAHalfOverItsRoot) {
  EXPECT_NEAR(height_bound_m({12, kDensity, 100}) / height_bound_m({6, kDensity, 100}), std::pow(2, 1.5),
              1e-9);
}

// From an up-crossing the harmonic is a sine, which a straight line over one period resembles: their
// correlation is sqrt(6) / pi, so the bound grows by 1 / sqrt(1 - 6 / pi^2).
TEST(HeightBound, PaysForTheDriftFromCrossingToCrossing) {
  const double expected = 1 / std::sqrt(1 - 6 / (std::numbers::pi * std::numbers::pi));
  const double ratio =
      height_bound_m({6, kDensity, 200, std::numbers::pi / 2}) / height_bound_m({6, kDensity, 200});
  EXPECT_NEAR(ratio, expected, 1e-3);
}

// The Fisher matrix the long way: numeric derivatives of the model in amplitude, phase, offset and drift.
TEST(HeightBound, EqualsANumericFisherMatrixInAmplitudeAndPhase) {
  const double period_s = 7.3, rate_hz = 50, w = 2 * std::numbers::pi / period_s,
               sigma = kDensity * std::sqrt(rate_hz / 2);
  for (const double phase : {0.0, 0.4, 1.1, 2.0}) {
    const Eigen::Vector4d truth(0.5, phase, 0.02, -0.003);
    const auto model = [&](const Eigen::Vector4d& p, double t) {
      return -p[0] * w * w * std::cos(w * t - p[1]) + p[2] + p[3] * t;
    };
    Eigen::Matrix4d fisher = Eigen::Matrix4d::Zero();
    for (int i = 0; i < std::lround(period_s * rate_hz); ++i) {
      const double t = (i + 0.5) / rate_hz;
      Eigen::Vector4d gradient;
      for (int k = 0; k < 4; ++k) {
        Eigen::Vector4d up = truth, down = truth;
        up[k] += 1e-5;
        down[k] -= 1e-5;
        gradient[k] = (model(up, t) - model(down, t)) / 2e-5;
      }
      fisher += gradient * gradient.transpose() / (sigma * sigma);
    }
    const double numeric = 2 * std::sqrt(fisher.inverse()(0, 0));
    EXPECT_NEAR(height_bound_m({period_s, kDensity, rate_hz, phase}) / numeric, 1, 1e-6) << phase;
  }
}

// The bound can be reached: least squares on simulated waves scatters by it, within the scatter of 4000
// trials.
TEST(HeightBound, IsReachedByLeastSquares) {
  const double period_s = 6, rate_hz = 20, w = 2 * std::numbers::pi / period_s,
               sigma = kDensity * std::sqrt(rate_hz / 2);
  const int samples = 120, trials = 4000;
  Eigen::MatrixXd design(samples, 4);
  for (int i = 0; i < samples; ++i) {
    const double t = (i + 0.5) / rate_hz;
    design.row(i) << -w * w * std::cos(w * t), -w * w * std::sin(w * t), 1, t;
  }
  const Eigen::MatrixXd solve = (design.transpose() * design).inverse() * design.transpose();
  RandomStream random(5, "bound");
  double sum = 0, squares = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::VectorXd a = design * Eigen::Vector4d(0.4, 0, 0.01, 0.002);
    for (int i = 0; i < samples; ++i) a[i] += random.gaussian(sigma);
    const Eigen::Vector4d fit = solve * a;
    const double height = 2 * std::hypot(fit[0], fit[1]);
    sum += height;
    squares += height * height;
  }
  const double deviation = std::sqrt(squares / trials - sum * sum / trials / trials);
  EXPECT_NEAR(deviation / height_bound_m({period_s, kDensity, rate_hz}), 1, 4 / std::sqrt(2.0 * trials));
}

TEST(HeightBound, IsUnknownWithoutNoiseOrSamples) {
  EXPECT_TRUE(std::isnan(height_bound_m({6, estimator::kUnknown, 100})));
  EXPECT_TRUE(std::isnan(height_bound_m({6, kDensity, 0})));
}

}  // namespace
}  // namespace waverig::evaluation
