#include "estimator/waves/height_budget.h"

#include <gtest/gtest.h>

#include <numbers>

namespace waverig::estimator {
namespace {

constexpr double kPi = std::numbers::pi, kG = kStandardGravity;

// A wave of vertical acceleration A sin(w t) and a pitch theta sin(w t + lag) in the x-z plane.
struct Scene {
  double amplitude = 0.2, theta = 0.05, lag = 0, period_s = 8;
  WaveSeries series;
  WaveFit fit;
  // along_mps2: amplitude of a horizontal motion in phase with the vertical one, instead of none.
  Scene(double theta_rad, double lag_rad, double along_mps2 = 0) : theta(theta_rad), lag(lag_rad) {
    const double w = 2 * kPi / period_s;
    series.set_sample_interval(0.01);
    for (int i = 0; i < 2400; ++i) {
      LevelledSample s;
      s.t_s = 0.01 * i;
      s.usable = true;
      s.up_mps2 = amplitude * std::sin(w * s.t_s);
      s.q_NB = quaternion_of({0, theta * std::sin(w * s.t_s + lag), 0});
      s.f_B = s.q_NB.conjugate() * Vector3d(along_mps2 * std::sin(w * s.t_s), 0, -kG - s.up_mps2);
      series.add(s);
    }
    fit = fit_wave(series, 8, 16, w, 0);
  }
};

SensorKnowledge nothing_unknown() {
  SensorKnowledge k;
  k.accel_bias_sigma_mps2 = k.accel_scale_sigma = k.accel_misalignment_sigma_rad = 0;
  k.gravity_sigma_mps2 = 1;
  return k;
}

TEST(HeightBudget, LevelOnlyTheScaleCountsAndItCountsOneToOne) {
  const Scene level(0, 0);
  SensorKnowledge k = nothing_unknown();
  k.accel_scale_sigma = 1e-3;
  k.accel_misalignment_sigma_rad = 1e-3;
  k.accel_bias_sigma_mps2 = 1e-2;
  const AmplitudeBudget budget = amplitude_budget(level.series, level.fit, k, 0, 0);
  EXPECT_NEAR(budget.calibration_sigma_mps2, 1e-3 * level.amplitude, 1e-3 * 1e-3 * level.amplitude);
  EXPECT_LT(budget.tilt_sigma_mps2, 1e-7);
}

// (m_xz + m_zx + b_x / g) times the horizontal specific force g theta.
TEST(HeightBudget, TiltAtTheWavesFrequencyCouplesMisalignmentAndBias) {
  SensorKnowledge k = nothing_unknown();
  const Scene in_phase(0.05, 0), across(0.05, kPi / 2);
  k.accel_misalignment_sigma_rad = 1e-3;
  EXPECT_NEAR(amplitude_budget(in_phase.series, in_phase.fit, k, 0, 0).tilt_sigma_mps2,
              std::sqrt(2.0) * 1e-3 * kG * 0.05, 0.03 * 1e-3 * kG * 0.05);
  EXPECT_LT(amplitude_budget(across.series, across.fit, k, 0, 0).tilt_sigma_mps2, 0.05 * 1e-3 * kG * 0.05);
  k = nothing_unknown();
  k.accel_bias_sigma_mps2 = 4e-3;
  EXPECT_NEAR(amplitude_budget(in_phase.series, in_phase.fit, k, 0, 0).tilt_sigma_mps2, 4e-3 * 0.05,
              0.03 * 4e-3 * 0.05);
}

// A bias leans the levelled frame by b / g, and the horizontal acceleration into the vertical.
TEST(HeightBudget, ABiasLeansTheFrameAgainstTheHorizontalMotion) {
  SensorKnowledge k = nothing_unknown();
  k.accel_bias_sigma_mps2 = 0.02;
  const Scene along(0, 0, 0.3);
  EXPECT_NEAR(amplitude_budget(along.series, along.fit, k, 0, 0).tilt_sigma_mps2, 0.02 / kG * 0.3,
              0.02 * 0.02 / kG * 0.3);
}

TEST(HeightBudget, TheSlopeAboutOneGCountsOneToOneBesideTheScale) {
  const Scene level(0, 0);
  SensorKnowledge k = nothing_unknown();
  k.accel_scale_sigma = 3e-3;
  k.accel_slope_sigma = 4e-3;
  EXPECT_NEAR(amplitude_budget(level.series, level.fit, k, 0, 0).calibration_sigma_mps2,
              5e-3 * level.amplitude, 1e-2 * 5e-3 * level.amplitude);
}

TEST(HeightBudget, AKnownGravityTellsTheScale) {
  const Scene level(0, 0);
  SensorKnowledge k = nothing_unknown();
  k.accel_scale_sigma = 1e-3;
  k.accel_bias_sigma_mps2 = 4e-3;
  k.gravity_sigma_mps2 = 0;
  const double excess = 0.008;  // of the mean vertical specific force
  const AmplitudeBudget budget = amplitude_budget(level.series, level.fit, k, excess, 0);
  // Two sources share the excess in proportion to their variances.
  const double s = 1e-3 * kG, b = 4e-3, share = s * s / (s * s + b * b);
  EXPECT_NEAR(budget.correction_mps2, share * excess / kG * level.amplitude, 1e-3 * excess / kG);
  EXPECT_NEAR(budget.calibration_sigma_mps2, 1e-3 * std::sqrt(1 - share) * level.amplitude,
              1e-6 * level.amplitude);
}

}  // namespace
}  // namespace waverig::estimator
