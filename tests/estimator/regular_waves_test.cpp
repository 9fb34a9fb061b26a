// What is stated of a regular wave, from the levelled acceleration alone.
#include "estimator/waves/regular_waves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kPi = std::numbers::pi, kPeriod_s = 6, kOmega = 2 * kPi / kPeriod_s, kRate_Hz = 50;

// A sensor of which all is known.
SensorKnowledge perfect() {
  return {.gravity_sigma_mps2 = 0,
          .accel_bias_sigma_mps2 = 0,
          .accel_scale_sigma = 0,
          .accel_misalignment_sigma_rad = 0,
          .gyro_bias_sigma_radps = 0,
          .gyro_scale_sigma = 0};
}

// A wave of this amplitude in noise of this density; extra(t) on top, nothing where known(t) is false.
std::vector<RegularWave> waves_of(
    double amplitude_mps2, double density, double duration_s, std::uint64_t seed = 1,
    const std::function<double(double)>& extra = [](double) { return 0.0; },
    const std::function<bool(double)>& known = [](double) { return true; },
    const RegularWaveSettings& settings = {}) {
  RandomStream noise(seed, "regular waves");
  WaveSeries series;
  series.set_sample_interval(1 / kRate_Hz);
  for (int i = 0; i < static_cast<int>(duration_s * kRate_Hz); ++i) {
    LevelledSample s;
    s.t_s = i / kRate_Hz;
    s.usable = known(s.t_s);
    s.up_mps2 = -amplitude_mps2 * std::sin(kOmega * s.t_s) +
                noise.gaussian(density * std::sqrt(kRate_Hz / 2)) + extra(s.t_s);
    s.f_B = {0, 0, -kStandardGravity - s.up_mps2};
    series.add(s);
  }
  return regular_waves(series, kPeriod_s, settings, perfect());
}

// H = 2 A / w^2 and, the phase being free, E[A^2] = A0^2 + sigma^2.
TEST(RegularWaves, TheirOwnNoiseIsTakenOutOfTheirHeights) {
  const auto waves = waves_of(0.1, 0.02, 600);
  ASSERT_GT(waves.size(), 80u);
  for (const RegularWave& wave : waves) {
    const double w = wave.fit.omega_radps;
    EXPECT_GT(wave.noise_sigma_m / wave.height_m, 0.05);
    EXPECT_NEAR(std::hypot(wave.height_m, wave.noise_sigma_m), 2 * wave.fit.amplitude_mps2() / (w * w),
                1e-12);
  }
}

// REFERENCE section 3: sigma_H = (2 / w^2) nd / sqrt(T).
TEST(RegularWaves, StateTheNoiseOfTheCramerRaoBound) {
  double stated = 0;
  const auto waves = waves_of(0.5, 0.01, 600);
  for (const RegularWave& wave : waves) stated += wave.noise_sigma_m / static_cast<double>(waves.size());
  EXPECT_NEAR(stated, 2 / (kOmega * kOmega) * 0.01 / std::sqrt(kPeriod_s), 0.15 * stated);
}

// The height goes with the square of the period.
TEST(RegularWaves, AnErrorOfThePeriodCountsTwice) {
  for (const RegularWave& wave : waves_of(0.5, 0.02, 300)) {
    EXPECT_GT(wave.timing.sigma_s, 0);
    EXPECT_NEAR(wave.frequency_sigma_m / wave.height_m, 2 * wave.timing.sigma_s / wave.timing.period_s,
                1e-12);
  }
}

// Between two gaps a wave has its own length alone, from its two crossings: each errs by its phase.
TEST(RegularWaves, AloneTheyStateWhatTheirOwnCrossingsAreWorth) {
  const auto waves = waves_of(
      0.5, 0.02, 600, 1, [](double) { return 0.0; }, [](double t) { return std::fmod(t, 20) < 12; });
  double alone = 0, ratio = 0;
  for (const RegularWave& wave : waves) {
    if (wave.timing.waves > 1) continue;
    alone += 1;
    const double phase_sigma = std::hypot(wave.noise_sigma_m / wave.height_m, 2 * kPi * 1e-4);
    ratio += wave.frequency_sigma_m / wave.height_m / (2 / kPi * phase_sigma);
  }
  ASSERT_GT(alone, 10);
  EXPECT_NEAR(ratio / alone, 1, 0.1);
}

TEST(RegularWaves, SayWhenTheyHardlyReachOutOfTheNoise) {
  const double density = 0.05;
  int flagged = 0, clear = 0;
  for (const double times : {5.5, 6.5})
    for (const RegularWave& wave : waves_of(times * density / std::sqrt(kPeriod_s), density, 900)) {
      const double w = wave.fit.omega_radps;
      const bool below = 2 * wave.fit.amplitude_mps2() / (w * w) < 6 * wave.noise_sigma_m;
      ++(below ? flagged : clear);
      EXPECT_EQ((wave.flags & flag::kBelowNoise) != 0, below);
    }
  EXPECT_GT(flagged, 10);
  EXPECT_GT(clear, 10);
}

// A wave whose form is not a harmonic's is no steady one, whatever its length.
TEST(RegularWaves, OneOfAnotherFormIsFlagged) {
  const double begin_s = 15 * kPeriod_s;  // from an up-crossing of heave on
  const auto waves = waves_of(0.5, 0.01, 180, 1, [&](double t) {
    return t > begin_s && t < begin_s + kPeriod_s ? 0.15 * std::sin(3 * kOmega * t) : 0.0;
  });
  int flagged = 0;
  for (const RegularWave& wave : waves) {
    const bool its_form = std::abs(wave.begin_s() - begin_s) < 1;
    if (!its_form && std::abs(wave.begin_s() - begin_s) < 1.5 * kPeriod_s) continue;  // its neighbours may be
    if (wave.begin_s() < 2 * kPeriod_s || wave.end_s() > 178 - kPeriod_s) continue;
    EXPECT_EQ((wave.flags & flag::kSettling) != 0, its_form) << wave.begin_s();
    flagged += its_form;
  }
  EXPECT_EQ(flagged, 1);
}

TEST(RegularWaves, AKnockSpeaksForTheNoiseOfItsOwnWaveAlone) {
  RandomStream knock(1, "knock");
  const auto knocked =
      waves_of(0.5, 0.01, 180, 1, [&](double t) { return t > 90 && t < 90.3 ? knock.gaussian(3) : 0.0; });
  const auto quiet = waves_of(0.5, 0.01, 180);
  ASSERT_EQ(knocked.size(), quiet.size());
  int louder = 0;
  for (std::size_t k = 0; k < quiet.size(); ++k)
    if (knocked[k].noise_sigma_m > 1.5 * quiet[k].noise_sigma_m) {
      ++louder;
      EXPECT_TRUE(knocked[k].begin_s() < 90.3 && knocked[k].end_s() > 90) << knocked[k].begin_s();
    }
  EXPECT_LE(louder, 1);
}

}  // namespace
}  // namespace waverig::estimator
