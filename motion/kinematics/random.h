// Named, seeded, portable random streams: the same numbers on every machine and with every standard library.
#pragma once
#include <cstdint>
#include <string_view>

namespace waverig {

// xoshiro256++ (Blackman & Vigna 2019), seeded by SplitMix64 from a seed and the stream's name.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);
  std::uint64_t bits();
  double uniform();  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double gaussian();  // mean 0, standard deviation 1 (ziggurat: no libm in the common path)
  double gaussian(double sigma) { return sigma * gaussian(); }

 private:
  std::uint64_t state_[4];
};

// A seed for a sub-task, e.g. one run of a campaign: independent of the order in which tasks run.
std::uint64_t derived_seed(std::uint64_t seed, std::string_view name, std::uint64_t index = 0);

}  // namespace waverig
