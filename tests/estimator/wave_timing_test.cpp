#include "estimator/waves/wave_timing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

std::vector<WaveEvent> even_events(std::size_t n, double period_s, double sigma_s, RandomStream& random) {
  std::vector<WaveEvent> events;
  for (std::size_t k = 0; k < n; ++k) {
    events.push_back({static_cast<double>(k) * period_s + random.gaussian(sigma_s), sigma_s, k > 0});
  }
  return events;
}

TEST(WaveTiming, EvenWavesShareTheirFrequencyNineAtATimeWithTheScatterItStates) {
  const double T = 6, sigma = 0.01;
  RandomStream random(1, "timing");
  double squares = 0;
  int shared = 0;
  constexpr int kSeeds = 400;
  for (int i = 0; i < kSeeds; ++i) {
    const std::vector<WaveTiming> timings = share_frequency(even_events(21, T, sigma, random));
    const WaveTiming& middle = timings[10];
    squares += std::pow((middle.period_s - T) / middle.sigma_s, 2);
    shared += middle.waves == kMostSharedWaves;
  }
  EXPECT_GT(shared, kSeeds * 97 / 100);
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 1, 0.12);
  // Slope of nine points: sigma sqrt(12 / (n (n^2 - 1))).
  EXPECT_NEAR(share_frequency(even_events(21, T, sigma, random))[10].sigma_s, sigma * std::sqrt(12.0 / 720),
              1e-9);
}

TEST(WaveTiming, AChangeOfSettingIsNotSmearedOverItsNeighbours) {
  std::vector<WaveEvent> events;
  double t = 0;
  for (std::size_t k = 0; k < 30; ++k) {
    events.push_back({t, 1e-3, k > 0});
    t += k < 15 ? 6.0 : 8.0;
  }
  const std::vector<WaveTiming> timings = share_frequency(events);
  for (std::size_t k = 0; k < 15; ++k) EXPECT_NEAR(timings[k].period_s, 6, 1e-9) << k;
  for (std::size_t k = 16; k < 30; ++k) EXPECT_NEAR(timings[k].period_s, 8, 1e-9) << k;
}

TEST(WaveTiming, ASteadilyChangingPeriodIsToldAtTheWaveItself) {
  std::vector<WaveEvent> events;
  const auto at = [](double k) { return 6 * k + 0.01 * k * k; };
  for (std::size_t k = 0; k < 30; ++k) events.push_back({at(static_cast<double>(k)), 2e-3, k > 0});
  const std::vector<WaveTiming> timings = share_frequency(events);
  for (std::size_t k = 5; k < 25; ++k) {
    EXPECT_NEAR(timings[k].period_s, 6 + 0.02 * static_cast<double>(k), 1e-9) << k;
    EXPECT_GE(timings[k].waves, 5U);
  }
}

TEST(WaveTiming, DoesNotReachAcrossABreak) {
  RandomStream random(3, "timing");
  std::vector<WaveEvent> events = even_events(20, 6, 0.001, random);
  for (std::size_t k = 10; k < 20; ++k) events[k].down_crossing_s += 3;  // the phase jumps
  events[10].follows = false;
  for (const WaveTiming& timing : share_frequency(events)) EXPECT_NEAR(timing.period_s, 6, 0.005);
  events.resize(1);
  EXPECT_EQ(share_frequency(events)[0].waves, 1U);
}

}  // namespace
}  // namespace waverig::estimator
