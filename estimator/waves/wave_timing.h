// The common frequency of neighbouring waves, from the times of their zero-down-crossings.
#pragma once
#include <cstddef>
#include <vector>

namespace waverig::estimator {

struct WaveEvent {
  double down_crossing_s = 0;
  double sigma_s = 0;
  bool follows = false;  // the wave before ends where this one begins
};

struct WaveTiming {
  double period_s = 0;
  double sigma_s = 0;          // of the period
  double down_crossing_s = 0;  // smoothed
  std::size_t waves = 0;       // how many shared the one frequency
};

inline constexpr std::size_t kMostSharedWaves = 9;

// For each wave the widest span of up to nine unbroken neighbours whose crossings agree, within their noise,
// with one frequency (or, symmetrically about the wave, with a steadily changing one); the period is the
// slope there. A wave that agrees with no neighbour has waves = 1 and no period.
std::vector<WaveTiming> share_frequency(const std::vector<WaveEvent>& events);

}  // namespace waverig::estimator
