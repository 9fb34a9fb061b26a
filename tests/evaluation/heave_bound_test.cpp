#include "estimator/evaluation/heave_bound.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "motion/kinematics/frames.h"

namespace waverig::evaluation {
namespace {

constexpr double kPi = std::numbers::pi, kInterval_s = 0.25;
constexpr double kNoise = 350e-6 * kStandardGravity;  // MMA7331LC class, one-sided

// Density of what is only known on the nodes: up to half their rate, where both sides fold onto each other.
double on_band(double f_hz, double density) {
  const double half_rate_hz = 0.5 / kInterval_s;
  return f_hz < half_rate_hz ? density : f_hz > half_rate_hz ? 0 : density / 2;
}

// A sea whose heave is white on the nodes, of two-sided density R, under noise that makes the corner of the
// best estimator w0 = (q / R)^(1/4).
HeaveBound white_sea(double R, double w0) {
  return HeaveBound({.density_m2_per_hz = [=](double f) { return on_band(f, 2 * R); },
                     .noise_density_mps2_rthz = std::sqrt(2 * R) * w0 * w0,
                     .interval_s = kInterval_s});
}

std::function<double(double)> pierson_moskowitz(double hm0_m, double tp_s) {
  return [=](double f) {
    if (f <= 0) return 0.0;
    const double x = std::pow(f * tp_s, -4);
    return 5.0 / 16 * hm0_m * hm0_m / f * x * std::exp(-1.25 * x);
  };
}

// z(k) = a1 z(k-1) + a2 z(k-2) + e(k): a sea of one peak, whose covariances are known by its recursion.
struct Ar2 {
  double a1, a2, innovation_m2;
  double variance_m2() const {
    return innovation_m2 * (1 - a2) / ((1 + a2) * ((1 - a2) * (1 - a2) - a1 * a1));
  }
  Eigen::VectorXd covariance(int lags) const {
    Eigen::VectorXd r(lags);
    r[0] = variance_m2();
    r[1] = a1 / (1 - a2) * r[0];
    for (int n = 2; n < lags; ++n) r[n] = a1 * r[n - 1] + a2 * r[n - 2];
    return r;
  }
  HeaveBound bound(double noise_density) const {
    const auto density = [*this](double f) {
      const std::complex<double> d = std::polar(1.0, -2 * kPi * f * kInterval_s);
      return on_band(f, 2 * kInterval_s * innovation_m2 / std::norm(1.0 - a1 * d - a2 * d * d));
    };
    return HeaveBound({density, noise_density, kInterval_s});
  }
};

Ar2 peaked_sea() {  // 6 s, poles at 0.97
  const double radius = 0.97, angle = 2 * kPi * kInterval_s / 6;
  return {2 * radius * std::cos(angle), -radius * radius, 1e-4};
}

// Drift, the integral of white noise of two-sided density q twice over, told apart from white heave: the
// causal error is sqrt(2) q^(1/4) R^(3/4), the steady solution of the double integrator's Riccati equation; a
// lag takes off the integral of the later weights g(-u) = sqrt(2 R) w0 e^-x cos x, x = w0 u / sqrt(2),
// squared; a quarter is left for ever.
TEST(HeaveBound, EqualsTheClosedFormOfWhiteHeaveOverDrift) {
  const double R = 0.3, w0 = 0.04;
  const HeaveBound bound = white_sea(R, w0);
  const double causal_m2 = std::sqrt(2) * R * w0;
  EXPECT_NEAR(std::pow(bound.steady_m(0), 2) / causal_m2, 1, 0.01);
  EXPECT_NEAR(std::pow(bound.steady_m(kWholeRecord_s), 2) / causal_m2, 0.25, 1e-4);
  for (const double lag_s : {5.0, 10.0, 20.0, 40.0}) {
    const double x2 = std::sqrt(2) * w0 * lag_s;
    EXPECT_NEAR(std::pow(bound.steady_m(lag_s), 2) / causal_m2,
                0.25 + std::exp(-x2) * (2 + std::cos(x2) - std::sin(x2)) / 4, w0 * kInterval_s)
        << lag_s;
  }
}

// The same of a bias that walks, the integral three times over of white noise of density 2 sb^2 / tb: by the
// entropy integral R int ln(1 + (w0 / w)^6) dw / 2 pi the causal error is 2 R w0, w0 = (2 sb^2 / (tb R))^(1/6).
TEST(HeaveBound, EqualsTheClosedFormOfWhiteHeaveOverAWalkingBias) {
  const double R = 0.3, w0 = 0.02, time_s = 1e4;
  const HeaveBound bound({.density_m2_per_hz = [=](double f) { return on_band(f, 2 * R); },
                          .noise_density_mps2_rthz = 1e-7,
                          .interval_s = kInterval_s,
                          .instability_sigma_mps2 = std::sqrt(R * std::pow(w0, 6) * time_s / 2),
                          .instability_time_s = time_s});
  EXPECT_NEAR(std::pow(bound.steady_m(0), 2) / (2 * R * w0), 1, 0.01);
}

// With hardly any noise, path and speed of the begin are the straight line through n nodes of white heave,
// whose newest point has the variance 2 (2 n - 1) / (n (n + 1)) of theirs.
TEST(HeaveBound, BeginsAsAStraightLineThroughWhiteHeave) {
  const HeaveBound bound = white_sea(1, 1e-4);
  const double variance = std::pow(bound.heave_std_m(), 2);
  EXPECT_NEAR(variance * kInterval_s, 1, 1e-3);
  for (const int n : {1, 2, 3, 4, 10, 30}) {
    const double t = (n - 1) * kInterval_s;
    EXPECT_NEAR(std::pow(bound.record_m(0, t, t), 2) / variance, 2.0 * (2 * n - 1) / (n * (n + 1)), 1e-4)
        << n;
  }
}

// Where the sea is far above the noise, the noise integrated twice over the sea's band is left.
TEST(HeaveBound, IsTheNoiseIntegratedTwiceOverTheBandOfTheSea) {
  const double f1 = 0.08, f2 = 0.4;
  const HeaveBound bound({[=](double f) { return f > f1 && f < f2 ? 1.0 : 0.0; }, kNoise, kInterval_s});
  const double integral =
      kNoise * kNoise / (16 * std::pow(kPi, 4)) / 3 * (std::pow(f1, -3) - std::pow(f2, -3));
  EXPECT_NEAR(bound.steady_m(kWholeRecord_s) / std::sqrt(integral), 1, 0.003);
}

// Above its corner the bias has the one-sided density sb^2 / (pi^2 f^2 tb).
TEST(HeaveBound, IsTheWanderingBiasIntegratedTwiceOverTheBandOfTheSea) {
  const double f1 = 0.08, f2 = 0.4, sigma_mps2 = 0.01, time_s = 1000;
  const HeaveBound bound({[=](double f) { return f > f1 && f < f2 ? 1.0 : 0.0; }, 1e-6, kInterval_s, sigma_mps2, time_s});
  const double integral = sigma_mps2 * sigma_mps2 / time_s / (16 * std::pow(kPi, 6)) / 5 *
                          (std::pow(f1, -5) - std::pow(f2, -5));
  EXPECT_NEAR(bound.steady_m(kWholeRecord_s) / std::sqrt(integral), 1, 0.003);
}

TEST(HeaveBound, IsTheSeaItselfWhereNoiseHidesIt) {
  const HeaveBound bound({pierson_moskowitz(1e-4, 12), kNoise, kInterval_s});
  for (const double lag_s : {0.0, 2.0, kWholeRecord_s})
    EXPECT_NEAR(bound.steady_m(lag_s) / bound.heave_std_m(), 1, 1e-4) << lag_s;
}

TEST(HeaveBound, HoldsTheVarianceOfTheSpectrum) {
  EXPECT_NEAR(HeaveBound({pierson_moskowitz(2, 8), kNoise, kInterval_s}).heave_std_m(), 0.5, 1e-4);
  // What is too fast for the nodes, four a second, is seen by them all the same, as something slower.
  const auto band = [](double f_hz) { return f_hz > 1 && f_hz < 3 ? 0.1 : 0.0; };
  EXPECT_NEAR(HeaveBound({band, kNoise, 0.25}).heave_std_m(), std::sqrt(0.2), 1e-3);
}

TEST(HeaveBound, FallsWithTheLagDownToTheWholeRecords) {
  for (const double tp_s : {3.0, 6.0, 12.0}) {
    const HeaveBound bound({pierson_moskowitz(1, tp_s), kNoise, kInterval_s});
    double last = bound.heave_std_m();
    for (const double lag_s : {0.0, 0.5, 1.0, 2.0, 5.0, 20.0, kWholeRecord_s}) {
      EXPECT_LT(bound.steady_m(lag_s), last) << tp_s << ' ' << lag_s;
      last = bound.steady_m(lag_s);
    }
    EXPECT_NEAR(bound.steady_m(15 * tp_s) / last, 1, 0.01) << tp_s;
    EXPECT_NEAR(bound.steady_m(100 * tp_s) / last, 1, 1e-4) << tp_s;
  }
}

// What is long is like what is high is like what is loud: heights and noise together are a change of the unit
// of length; period and interval, noise by their power of -3/2, one of time.
TEST(HeaveBound, KnowsNoUnits) {
  const HeaveBound bound({pierson_moskowitz(1, 6), kNoise, kInterval_s}),
      higher({pierson_moskowitz(3, 6), 3 * kNoise, kInterval_s}),
      longer({pierson_moskowitz(1, 12), kNoise * std::pow(2, -1.5), 2 * kInterval_s});
  for (const double lag_s : {0.0, 2.0, kWholeRecord_s}) {
    EXPECT_NEAR(higher.steady_m(lag_s) / bound.steady_m(lag_s), 3, 1e-6) << lag_s;
    EXPECT_NEAR(longer.steady_m(2 * lag_s) / bound.steady_m(lag_s), 1, 1e-4) << lag_s;
    EXPECT_NEAR(higher.record_m(lag_s, 300) / bound.record_m(lag_s, 300), 3, 1e-6) << lag_s;
  }
}

TEST(HeaveBound, HardlyDependsOnNodesThatAreFine) {
  for (const double hm0_m : {0.5, 4.0}) {
    const HeaveBound bound({pierson_moskowitz(hm0_m, 12), kNoise, 0.25}),
        finer({pierson_moskowitz(hm0_m, 12), kNoise, 0.125});
    for (const double lag_s : {0.0, 0.5, 2.0, kWholeRecord_s}) {
      EXPECT_NEAR(finer.steady_m(lag_s) / bound.steady_m(lag_s), 1, 0.015) << hm0_m << ' ' << lag_s;
      EXPECT_NEAR(finer.record_m(lag_s, 1200) / bound.record_m(lag_s, 1200), 1, 0.03)
          << hm0_m << ' ' << lag_s;
    }
  }
}

// The other way to the same figure: a Kalman filter of sea and drift that starts knowing nothing of path and
// speed. State: the last nine heaves, drift and its rate.
TEST(HeaveBound, EqualsTheRiccatiEquationOfAKalmanFilter) {
  constexpr int kHeaves = 9, kStates = kHeaves + 2;
  const Ar2 sea = peaked_sea();
  const HeaveBound bound = sea.bound(kNoise);
  const double q = kNoise * kNoise / 2, dt = kInterval_s;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(kStates, kStates), Q = F, P = F;
  F(0, 0) = sea.a1;
  F(0, 1) = sea.a2;
  for (int i = 1; i < kHeaves; ++i) F(i, i - 1) = 1;
  F.bottomRightCorner<2, 2>() << 1, dt, 0, 1;
  Q(0, 0) = sea.innovation_m2;
  Q.bottomRightCorner<2, 2>() << q * dt * dt * dt / 3, q * dt * dt / 2, q * dt * dt / 2, q * dt;
  const Eigen::VectorXd r = sea.covariance(kHeaves);
  for (int i = 0; i < kHeaves; ++i)
    for (int j = 0; j < kHeaves; ++j) P(i, j) = r[std::abs(i - j)];
  P.bottomRightCorner<2, 2>() = Eigen::Vector2d(1e4, 1e4).asDiagonal();
  Eigen::VectorXd h = Eigen::VectorXd::Zero(kStates);
  h[0] = h[kHeaves] = 1;
  for (int k = 0; k < 4000; ++k) {
    if (k > 0) P = F * P * F.transpose() + Q;
    const Eigen::VectorXd Ph = P * h;
    P -= Ph * Ph.transpose() / h.dot(Ph);
    if (k == 2 || k == 8 || k == 40 || k == 200) {
      EXPECT_NEAR(bound.record_m(0, k * dt, k * dt) / std::sqrt(P(0, 0)), 1, 1e-4) << k;
    }
  }
  EXPECT_NEAR(bound.steady_m(0) / std::sqrt(P(0, 0)), 1, 1e-5);
  EXPECT_NEAR(bound.steady_m(2) / std::sqrt(P(8, 8)), 1, 1e-5);
}

// And a third: best linear estimates from all second differences of a record of ninety seconds, by their
// covariances in time.
TEST(HeaveBound, HoldsForEveryNodeOfARecord) {
  constexpr int kLast = 360;
  const Ar2 sea = peaked_sea();
  const HeaveBound bound = sea.bound(kNoise);
  const Eigen::VectorXd r = sea.covariance(kLast + 1);
  const auto heave = [&](int n) { return r[std::abs(n)]; };
  const double drift = kNoise * kNoise / 2 * std::pow(kInterval_s, 3);
  Eigen::MatrixXd yy(kLast - 1, kLast - 1), zy(kLast + 1, kLast - 1);
  for (int i = 2; i <= kLast; ++i) {
    for (int j = 2; j <= kLast; ++j) {
      const int n = std::abs(i - j);
      const double fourth = 6 * heave(n) - 4 * (heave(n - 1) + heave(n + 1)) + heave(n - 2) + heave(n + 2);
      yy(i - 2, j - 2) = fourth + drift * (n == 0 ? 2.0 / 3 : n == 1 ? 1.0 / 6 : 0);
    }
    for (int k = 0; k <= kLast; ++k) zy(k, i - 2) = heave(k - i) - 2 * heave(k - i + 1) + heave(k - i + 2);
  }
  for (const double lag_s : {0.0, 2.0, kWholeRecord_s}) {
    double sum = 0;
    for (int k = 0; k <= kLast; ++k) {
      const int known =
          std::isfinite(lag_s) ? std::min(kLast, k + static_cast<int>(lag_s / kInterval_s)) - 1 : kLast - 1;
      double left = heave(0);
      if (known > 0) {
        const Eigen::VectorXd c = zy.row(k).head(known);
        left -= c.dot(yy.topLeftCorner(known, known).llt().solve(c));
      }
      sum += left;
    }
    EXPECT_NEAR(bound.record_m(lag_s, kLast * kInterval_s) / std::sqrt(sum / (kLast + 1)), 1, 0.002) << lag_s;
  }
}

TEST(HeaveBound, IsUnknownWithoutNoise) {
  for (const double noise : {estimator::kUnknown, 0.0}) {
    const HeaveBound bound({pierson_moskowitz(1, 6), noise, kInterval_s});
    EXPECT_TRUE(std::isnan(bound.steady_m(0)));
    EXPECT_TRUE(std::isnan(bound.record_m(kWholeRecord_s, 1200)));
    EXPECT_TRUE(std::isnan(bound.heave_std_m()));
  }
}

}  // namespace
}  // namespace waverig::evaluation
