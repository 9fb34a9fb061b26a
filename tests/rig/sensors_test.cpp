#include <gtest/gtest.h>

#include <vector>

#include "estimator/calibration/allan.h"
#include "lcmtypes/error.h"
#include "rig/sensors/accelerometer.h"
#include "rig/sensors/gyroscope.h"

namespace waverig::rig {
namespace {

constexpr double kG = kStandardGravity, kInterval = 0.01;
const Vector3d kRest(0.3, -0.5, -kG);

// The settled output of a unit at rest, without noise.
Vector3d settled(const AccelerometerSettings& s, const AccelerometerParameters& unit, const Vector3d& f_B,
                 double temperature = kReferenceTemperature_degC) {
  Accelerometer sensor(s, unit, kInterval, 1);
  sensor.begin_interval(temperature);
  return sensor.respond(f_B, 0);
}

TEST(Accelerometer, WithEveryEffectOffGivesWhatItFeels) {
  const AccelerometerSettings off;
  Accelerometer sensor(off, draw_accelerometer(off, 1), kInterval, 1);
  for (int k = 0; k < 10; ++k) {
    sensor.begin_interval(40);
    EXPECT_EQ(sensor.respond(kRest * k, kInterval), kRest * k);
    EXPECT_EQ(sensor.interval_noise_mps2(), Vector3d::Zero());
  }
}

TEST(Accelerometer, EachEffectIsOffByItsOwnZero) {
  struct Case {
    double AccelerometerSettings::*sigma;
    bool changes_unit;
  };
  for (const Case& c : {Case{&AccelerometerSettings::bias_sigma_mps2, true},
                        {&AccelerometerSettings::scale_sigma, true},
                        {&AccelerometerSettings::misalignment_sigma, true},
                        {&AccelerometerSettings::nonlinearity_sigma, true},
                        {&AccelerometerSettings::bias_drift_sigma_mps2pdegC, true},
                        {&AccelerometerSettings::scale_drift_sigma_pdegC, true},
                        {&AccelerometerSettings::instability_sigma_mps2, false},
                        {&AccelerometerSettings::noise_density_mps2, false}}) {
    AccelerometerSettings s;
    s.range_mps2 = 4 * kG;
    s.*c.sigma = 1e-3;
    const AccelerometerParameters unit = draw_accelerometer(s, 5);
    Accelerometer sensor(s, unit, kInterval, 1);
    sensor.begin_interval(35);
    EXPECT_GT((sensor.respond(kRest, kInterval) + sensor.interval_noise_mps2() - kRest).norm(), 1e-6);
    s.*c.sigma = 0;
    Accelerometer clean(s, c.changes_unit ? draw_accelerometer(s, 5) : unit, kInterval, 1);
    clean.begin_interval(35);
    EXPECT_EQ(clean.respond(kRest, kInterval), kRest);
  }
}

TEST(Accelerometer, ReproducesThePublishedUnit) {
  const AccelerometerParameters unit = lee2014_accelerometer();
  const Vector3d out = settled({}, unit, {kG, 0, 0}) / kG;  // x up: first column of M, and b
  EXPECT_LT((out - Vector3d(1.0074 - 0.0354, -0.0065 + 0.0081, -0.0027 + 0.0041)).norm(), 1e-12);
}

TEST(Accelerometer, DrawsUnitsAsWideAsStated) {
  const AccelerometerSettings s = mma7331lc();
  double bias = 0, scale = 0, drift = 0;
  constexpr int kUnits = 2000;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const AccelerometerParameters unit = draw_accelerometer(s, seed);
    bias += unit.bias_mps2.squaredNorm() / (3 * kUnits);
    scale += (unit.M.diagonal() - Vector3d::Ones()).squaredNorm() / (3 * kUnits);
    drift += unit.bias_drift_mps2pdegC.squaredNorm() / (3 * kUnits);
  }
  EXPECT_NEAR(std::sqrt(bias) / s.bias_sigma_mps2, 1, 0.04);
  EXPECT_NEAR(std::sqrt(scale) / s.scale_sigma, 1, 0.04);
  EXPECT_NEAR(std::sqrt(drift) / s.bias_drift_sigma_mps2pdegC, 1, 0.04);
}

TEST(Accelerometer, BendsAsFarFromTheBestStraightLineAsDrawn) {
  AccelerometerSettings s;
  s.range_mps2 = 4 * kG;
  const double span = 8 * kG, bend = 0.002;
  for (const bool even : {true, false}) {
    AccelerometerParameters unit;
    if (even)
      unit.quadratic_pmps2.setConstant(4 * bend / s.range_mps2);
    else
      unit.cubic_pmps4.setConstant(8 * bend / (s.range_mps2 * s.range_mps2));
    AccelerometerSettings wide = s;
    wide.range_mps2 = 0;
    // The smallest largest deviation from any straight line a + b u, by a fine search.
    double best = 1;
    for (double slope = 0.98; slope <= 1.02; slope += 0.0005) {
      double low = 1e9, high = -1e9;
      for (double u = -4 * kG; u <= 4 * kG; u += 0.01 * kG) {
        const double miss = settled(wide, unit, {u, 0, 0}).x() - slope * u;
        low = std::min(low, miss);
        high = std::max(high, miss);
      }
      best = std::min(best, 0.5 * (high - low) / span);
    }
    EXPECT_NEAR(best, bend, 0.05 * bend) << even;
  }
}

TEST(Accelerometer, NoUnitIsDrawnBeyondItsNonlinearityLimit) {
  AccelerometerSettings s = mma7331lc();
  s.nonlinearity_sigma = 0.02;  // so that most would be
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    EXPECT_LE(draw_accelerometer(s, seed).quadratic_pmps2.cwiseAbs().maxCoeff(),
              4 * 0.01 / s.range_mps2 * (1 + 1e-12));
}

TEST(Accelerometer, DriftsWithTemperature) {
  AccelerometerParameters unit;
  unit.bias_drift_mps2pdegC << 0.005, 0, 0;
  unit.scale_drift_pdegC << 0, 0, 2e-4;
  const Vector3d out = settled({}, unit, kRest, kReferenceTemperature_degC + 10);
  EXPECT_NEAR(out.x(), kRest.x() + 0.05, 1e-12);
  EXPECT_NEAR(out.z(), kRest.z() * 1.002, 1e-12);
}

TEST(Accelerometer, LowPassHasItsGainAndStepResponse) {
  AccelerometerSettings s;
  s.bandwidth_Hz.setConstant(10);
  Accelerometer sensor(s, {}, kInterval, 1);
  const double tau = 1 / (2 * std::numbers::pi * 10), dt = 1e-3;
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    const double out = sensor.respond({std::sin(2 * std::numbers::pi * 20 * k * dt), 0, 0}, dt).x();
    if (k > 1000) largest = std::max(largest, out);
  }
  EXPECT_NEAR(largest, 1 / std::hypot(1, 2), 5e-3);  // a sine of 50 points a period, straight between them
  Accelerometer step(s, {}, kInterval, 1);
  step.respond({0, 0, 0}, 0);
  const double ramp = step.respond({1, 0, 0}, dt).x();  // linear within a step: exact for any step
  EXPECT_NEAR(ramp, 1 - tau / dt * (1 - std::exp(-dt / tau)), 1e-12);
  double out = 0;
  for (int k = 1; k <= 20; ++k) out = step.respond({1, 0, 0}, dt).x();
  EXPECT_NEAR(1 - out, (1 - ramp) * std::exp(-20 * dt / tau), 1e-12);
}

TEST(Accelerometer, StandsAtItsRange) {
  AccelerometerSettings s;
  s.range_mps2 = 4 * kG;
  EXPECT_EQ(settled(s, {}, {5 * kG, -6 * kG, kG}), Vector3d(4 * kG, -4 * kG, kG));
}

TEST(Accelerometer, InstabilityHasItsSigmaAndItsTime) {
  AccelerometerSettings s;
  s.instability_sigma_mps2 = 1e-3;
  s.instability_time_s = 0.5;
  Accelerometer sensor(s, {}, kInterval, 3);
  constexpr int kSamples = 400000, kLag = 50;
  std::vector<double> x;
  for (int k = 0; k < kSamples; ++k) {
    sensor.begin_interval(25);
    x.push_back(sensor.respond({0, 0, 0}, kInterval).x());
  }
  double square = 0, lagged = 0;
  for (std::size_t k = kLag; k < x.size(); ++k) {
    square += x[k] * x[k];
    lagged += x[k] * x[k - kLag];
  }
  EXPECT_NEAR(std::sqrt(square / kSamples) / 1e-3, 1, 0.03);
  EXPECT_NEAR(lagged / square, std::exp(-1), 0.04);
}

TEST(Accelerometer, SigmaMeansSigma) {
  AccelerometerSettings s;
  s.noise_density_mps2 = 350e-6 * kG;
  Accelerometer sensor(s, {}, kInterval, 7);
  std::vector<double> noise;
  for (int k = 0; k < 200000; ++k) {
    sensor.begin_interval(25);
    noise.push_back(sensor.interval_noise_mps2().z());
  }
  const auto terms = estimator::fit_allan(estimator::allan_deviation(noise, kInterval));
  EXPECT_NEAR(terms.one_sided_density() / s.noise_density_mps2, 1, 0.01);
}

Vector3d mean_reading(const GyroscopeSettings& s, const GyroscopeParameters& unit, const Vector3d& w,
                      const Vector3d& f, double temperature = kReferenceTemperature_degC) {
  Gyroscope sensor(s, unit, kInterval, 1);
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 2000; ++k) sum += sensor.sample(w, f, temperature).counts.cast<double>();
  return sum / 2000 * gyroscope_count_radps(s);
}

TEST(Gyroscope, WithEveryEffectOffGivesWhatItFeels) {
  const Vector3d w(0.1, -0.2, 0.3);
  EXPECT_LT((mean_reading({}, {}, w, kRest, 40) - w).cwiseAbs().maxCoeff(), 0.5e-6);
}

TEST(Gyroscope, CountsByItsDatasheet) {
  EXPECT_NEAR(gyroscope_count_radps(fxas21000(200)), 0.025 * kDegree, 1e-15);
  EXPECT_NEAR(gyroscope_count_radps(fxas21000(1600)), 0.2 * kDegree, 1e-15);
  EXPECT_THROW(fxas21000(300), UserError);
  GyroscopeSettings s;
  s.lsb_radps = 0.025 * kDegree;
  EXPECT_EQ(Gyroscope(s, {}, kInterval, 1).sample({1 * kDegree, 0, -0.05 * kDegree}, kRest, 25).counts,
            Eigen::Vector3i(40, 0, -2));
}

TEST(Gyroscope, NoUnitIsDrawnBeyondTheOffsetThatItsDataSheetAllows) {
  GyroscopeSettings s;
  s.offset_sigma_radps = 1;
  s.offset_limit_radps = 1.5;
  double largest = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    largest = std::max(largest, draw_gyroscope(s, seed).offset_radps.cwiseAbs().maxCoeff());
  EXPECT_EQ(largest, 1.5);
}

TEST(Gyroscope, AddsOffsetTemperatureAndGravity) {
  GyroscopeParameters unit;
  unit.offset_radps << 0.01, 0, 0;
  unit.offset_drift_radpspdegC << 0, 0.002, 0;
  unit.g_sensitivity_s_rad_m << 0, 0, 0.001;
  const Vector3d out = mean_reading({}, unit, Vector3d::Zero(), kRest, kReferenceTemperature_degC + 5);
  EXPECT_LT((out - Vector3d(0.01, 0.01, -0.001 * kG)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Gyroscope, StandsAtItsRangeAndSaysSo) {
  const GyroscopeSettings s = [] {
    GyroscopeSettings bare;
    bare.lsb_radps = fxas21000().lsb_radps;
    bare.largest_count = fxas21000().largest_count;
    return bare;
  }();
  Gyroscope sensor(s, {}, kInterval, 1);
  EXPECT_FALSE(sensor.sample({200 * kDegree, 0, 0}, kRest, 25).saturated);
  const GyroscopeReading reading = sensor.sample({0, -300 * kDegree, 0}, kRest, 25);
  EXPECT_TRUE(reading.saturated);
  EXPECT_EQ(reading.counts.y(), -8191);
}

TEST(Gyroscope, SigmaMeansSigma) {
  GyroscopeSettings s = fxas21000();
  s.instability_sigma_radps = 0;
  Gyroscope sensor(s, {}, kInterval, 7);
  std::vector<double> rate;
  for (int k = 0; k < 200000; ++k)
    rate.push_back(sensor.sample(Vector3d::Zero(), kRest, 25).counts.x() * s.lsb_radps);
  // Rounding to 1/7 of the noise adds its variance, q^2/12: 0.1 % of density.
  const auto terms = estimator::fit_allan(estimator::allan_deviation(rate, kInterval));
  EXPECT_NEAR(terms.one_sided_density() / s.noise_density_radps, 1, 0.01);
}

TEST(Temperature, WarmsUpAndSwings) {
  const TemperatureSettings t{20, 2, 100, 3, 50};
  EXPECT_DOUBLE_EQ(temperature_degC(t, 0), 20);
  EXPECT_NEAR(temperature_degC(t, 25), 20 + 2 + 3 * (1 - std::exp(-0.5)), 1e-12);
  EXPECT_NEAR(temperature_degC(t, 1e5), 23, 1e-9);
}

}  // namespace
}  // namespace waverig::rig
