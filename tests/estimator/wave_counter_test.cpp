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
    if (const auto wave = counter.add(h, 0.01)) waves.push_back(*wave);
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
    if (const auto wave = counter.add(sample_at(i), 0)) {
      ++whole;
      EXPECT_FALSE(wave->start_utime < 455 * 50'000 && 455 * 50'000 < wave->start_utime + 5'000'000);
    }
  }
  EXPECT_EQ(whole, 8);
}

}  // namespace
}  // namespace waverig::estimator
