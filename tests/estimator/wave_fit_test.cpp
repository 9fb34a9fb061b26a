#include "estimator/waves/wave_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <numbers>

#include "estimator/waves/wave_finder.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kPi = std::numbers::pi;

WaveSeries series_of(const std::function<double(double)>& up_mps2, double duration_s, double rate_Hz) {
  WaveSeries series;
  series.set_sample_interval(1 / rate_Hz);
  const auto count = static_cast<int>(duration_s * rate_Hz);
  for (int i = 0; i < count; ++i) {
    LevelledSample s;
    s.t_s = i / rate_Hz;
    s.usable = true;
    s.up_mps2 = up_mps2(s.t_s);
    series.add(s);
  }
  return series;
}

TEST(WaveFit, RecoversAHarmonicExactlyBesideSecondHarmonicOffsetAndKnownDrift) {
  for (const double T : {1.0, 2.7, 12.0}) {
    const double w = 2 * kPi / T;
    const auto up = [&](double t) {
      return 0.5 * std::cos(w * t + 1) + 0.05 * std::cos(2 * w * t + 2) + 0.03 + 0.004 * (t - 2.5 * T);
    };
    const WaveSeries series = series_of(up, 4 * T, 100);
    const WaveFit fit = fit_wave(series, 2 * T, 3 * T, w, 0.004);
    ASSERT_TRUE(fit.valid);
    EXPECT_NEAR(fit.amplitude_mps2(), 0.5, 2e-5 * 0.5) << T;
    EXPECT_NEAR(fit.offset_mps2, 0.03, 1e-5) << T;
    // a = R sin(w (t - d)), so cos(w t + 1) crosses upward where w t + 1 = -pi/2 + 2 pi n.
    const double d = (-kPi / 2 - 1 + 6 * kPi) / w;
    EXPECT_NEAR(std::remainder(fit.down_crossing_s() - d, T), 0, 1e-5 * T) << T;
  }
}

TEST(WaveFit, IsNotMisledByAGap) {
  const double w = 2 * kPi / 6;
  WaveSeries series;
  series.set_sample_interval(0.01);
  for (int i = 0; i < 1800; ++i) {
    if (i > 900 && i < 1000) continue;
    LevelledSample s;
    s.t_s = 0.01 * i;
    s.usable = true;
    s.up_mps2 = 0.5 * std::cos(w * s.t_s) + 0.1;
    series.add(s);
  }
  EXPECT_NEAR(fit_wave(series, 6, 12, w, 0).amplitude_mps2(), 0.5, 1e-5);
  EXPECT_FALSE(fit_wave(series, 7.5, 10.5, 2 * kPi / 3, 0).valid);  // a third of it is missing
}

// Scatter of the amplitude over many seeds against the inverse of the Fisher matrix, built here on its own.
TEST(WaveFit, ScattersAsTheFisherMatrixSaysAndStatesIt) {
  const double T = 6, w = 2 * kPi / T, density = 3.4e-3, rate_Hz = 50;
  const double sigma = density * std::sqrt(rate_Hz / 2);
  Eigen::Matrix3d fisher = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 300; ++i) {
    const double t = i / rate_Hz;
    const Eigen::Vector3d row(std::cos(w * t), std::sin(w * t), 1);
    fisher += row * row.transpose() / (sigma * sigma);
  }
  const double bound = std::sqrt(fisher.inverse()(1, 1));

  RandomStream noise(1, "fit");
  constexpr int kSeeds = 500;
  double squares = 0, density_sum = 0, stated = 0;
  for (int i = 0; i < kSeeds; ++i) {
    const WaveSeries series =
        series_of([&](double t) { return 0.4 * std::sin(w * t) + noise.gaussian(sigma); }, T, rate_Hz);
    const WaveFit fit = fit_wave(series, -0.005, T, w, 0);
    squares += std::pow(fit.amplitude_mps2() - 0.4, 2);
    density_sum += fit.noise_density * fit.noise_density;
    stated += fit.sigma_per_density * density;
  }
  EXPECT_NEAR(std::sqrt(squares / kSeeds) / bound, 1, 0.1);
  EXPECT_NEAR(stated / kSeeds / bound, 1, 0.02);
  EXPECT_NEAR(std::sqrt(density_sum / kSeeds) / density, 1, 0.03);
}

TEST(WaveFinder, FindsThePeriodAndEveryWholeWave) {
  RandomStream noise(2, "find");
  for (const double T : {1.0, 4.0, 12.0, 20.0}) {
    const double w = 2 * kPi / T, duration_s = std::max(60.0, 12 * T);
    const WaveSeries series =
        series_of([&](double t) { return -0.05 * std::sin(w * (t - 0.3 * T)) + noise.gaussian(0.024); },
                  duration_s, 100);
    const std::optional<double> period_s = dominant_period_s(series, {});
    ASSERT_TRUE(period_s.has_value());
    EXPECT_NEAR(*period_s, T, 0.02 * T);
    const std::vector<WaveSpan> spans = find_waves(series, *period_s);
    EXPECT_NEAR(static_cast<double>(spans.size()), duration_s / T - 1, 1.5) << T;
    for (const WaveSpan& span : spans) {  // heave = +sin: up-crossing at 0.3 T
      EXPECT_NEAR(std::remainder(span.begin_s - 0.3 * T, T), 0, 0.1 * T) << T;
    }
  }
}

TEST(WaveFinder, FindsNoPeriodInNoiseAlone) {
  RandomStream noise(3, "find");
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    found +=
        dominant_period_s(series_of([&](double) { return noise.gaussian(0.024); }, 100, 100), {}).has_value();
  }
  EXPECT_LE(found, 1);
}

}  // namespace
}  // namespace waverig::estimator
