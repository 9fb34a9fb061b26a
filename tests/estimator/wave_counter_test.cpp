#include "estimator/heave/wave_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kPeriod_s = 5, kHeight_m = 2;

// Heave of one period after the other, better known above its mean than below.
HeaveSample sample_at(int i) {
  HeaveSample h;
  h.utime = 50'000LL * i;
  h.heave_m = 0.5 * kHeight_m * std::sin(2 * std::numbers::pi * 0.05 * i / kPeriod_s - 0.1);
  h.heave_sigma_m = h.heave_m > 0 ? 0.01 : 0.03;
  return h;
}

TEST(WaveCounter, StatesWhatCrestAndTroughScatterByAndWhatTheyHaveInCommon) {
  SensorKnowledge sensor;
  sensor.accel_scale_sigma = 0.003;
  sensor.accel_slope_sigma = 0.004;
  WaveCounter counter(sensor);
  std::vector<Wave> waves;
  for (int i = 0; i < 1000; ++i) {
    HeaveSample h = sample_at(i);
    if (i == 450) h.flags = flag::kSaturation;
    if (const auto wave = counter.add(h, 0, 0.01)) waves.push_back(*wave);
  }
  ASSERT_EQ(waves.size(), 9u);
  for (const Wave& wave : waves) {
    EXPECT_NEAR(wave.period_s, kPeriod_s, 1e-3);
    EXPECT_NEAR(wave.height_m, kHeight_m, 2e-3);
    EXPECT_NEAR(wave.noise_sigma_m, std::hypot(0.01, 0.03), 1e-12);
    EXPECT_NEAR(wave.calibration_sigma_m, 0.005 * wave.height_m, 1e-12);
    EXPECT_NEAR(wave.tilt_sigma_m, 0.01 * wave.height_m, 1e-12);
    const bool holds = wave.start_utime < 450 * 50'000 && 450 * 50'000 < wave.start_utime + 5'000'000;
    EXPECT_EQ(wave.flags, holds ? flag::kSaturation : 0);
  }
}

TEST(WaveCounter, NoWaveReachesOverAGap) {
  WaveCounter counter({});
  int whole = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 455) counter.gap();
    if (const auto wave = counter.add(sample_at(i), 0, 0)) {
      ++whole;
      EXPECT_FALSE(wave->start_utime < 455 * 50'000 && 455 * 50'000 < wave->start_utime + 5'000'000);
    }
  }
  EXPECT_EQ(whole, 8);
}


// Crests lie between the samples: of five a wave the highest is up to a fifth too low.
TEST(WaveCounter, FindsCrestAndTroughBetweenSamples) {
  for (const int samples_a_wave : {8, 12, 20}) {
    WaveCounter counter({});
    int whole = 0;
    for (int i = 0; i < 40 * samples_a_wave; ++i) {
      const double w = 2 * std::numbers::pi / kPeriod_s, t = 0.0301 + i * kPeriod_s / samples_a_wave;
      HeaveSample h;
      h.utime = std::llround(t * 1e6);
      h.heave_m = 0.5 * kHeight_m * std::sin(w * t);
      h.heave_rate_mps = 0.5 * kHeight_m * w * std::cos(w * t);
      h.heave_sigma_m = 0.001;
      if (const auto wave = counter.add(h, 0, 0)) {
        ++whole;
        EXPECT_NEAR(wave->height_m / kHeight_m, 1, samples_a_wave == 8 ? 0.01 : 0.002) << samples_a_wave;
      }
    }
    EXPECT_GT(whole, 35);
  }
}

// Else a low sea's mean height and period are those of its higher waves.
TEST(WaveCounter, CountsTheSmallWavesOfASeaThatIsWellAboveItsNoise) {
  WaveCounter counter({});
  int whole = 0;
  for (int i = 0; i < 4000; ++i) {
    HeaveSample h = sample_at(i);
    h.heave_m *= i / 100 % 4 == 3 ? 0.05 : 0.5;  // every fourth wave is a tenth of the others
    h.heave_sigma_m = 0.04;
    if (counter.add(h, 0, 0)) ++whole;
  }
  EXPECT_GE(whole, 38);  // of 39; the first ones are small
}

TEST(WaveCounter, MakesNoWavesOfNoise) {
  WaveCounter counter({});
  for (int i = 0; i < 4000; ++i) {
    HeaveSample h = sample_at(i);
    h.heave_m *= 0.05;
    h.heave_sigma_m = 0.04;
    EXPECT_FALSE(counter.add(h, 0, 0));
  }
}

// What all waves have in common is told apart from what each has of its own, not in both.
TEST(WaveCounter, LeavesTheSystematicPartOutOfTheNoise) {
  WaveCounter counter({});
  std::vector<Wave> waves;
  for (int i = 0; i < 1000; ++i) {
    HeaveSample h = sample_at(i);
    h.heave_sigma_m = 0.05;
    if (const auto wave = counter.add(h, 0.04, 0)) waves.push_back(*wave);
  }
  ASSERT_FALSE(waves.empty());
  for (const Wave& wave : waves) EXPECT_NEAR(wave.noise_sigma_m, std::hypot(0.03, 0.03), 1e-12);
}

}  // namespace
}  // namespace waverig::estimator
