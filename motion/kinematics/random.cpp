#include "motion/kinematics/random.h"

#include <array>
#include <bit>
#include <cmath>

namespace waverig {
namespace {

std::uint64_t split_mix(std::uint64_t& x) {
  std::uint64_t z = (x += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

// Ziggurat of 128 boxes of equal area under exp(-x^2/2); Doornik 2005, "ZIGNOR".
constexpr int kBoxes = 128;
constexpr double kTail = 3.442619855899;       // where the tail begins
constexpr double kArea = 9.91256303526217e-3;  // of each box

struct Ziggurat {
  std::array<double, kBoxes + 1> x{};
  std::array<double, kBoxes> ratio{};
  Ziggurat() {
    double f = std::exp(-0.5 * kTail * kTail);
    x[0] = kArea / f;
    x[1] = kTail;
    for (std::size_t i = 2; i < kBoxes; ++i) {
      x[i] = std::sqrt(-2 * std::log(kArea / x[i - 1] + f));
      f = std::exp(-0.5 * x[i] * x[i]);
    }
    for (std::size_t i = 0; i < kBoxes; ++i) ratio[i] = x[i + 1] / x[i];
  }
};
const Ziggurat kZiggurat;

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  std::uint64_t x = seed ^ fnv1a(name);
  for (auto& word : state_) word = split_mix(x);
}

std::uint64_t RandomStream::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomStream::gaussian() {
  for (;;) {
    const std::uint64_t word = bits();
    const double u = static_cast<double>(word >> 11) * 0x1p-52 - 1;  // [-1, 1)
    const std::size_t box = word & (kBoxes - 1);
    if (std::abs(u) < kZiggurat.ratio[box]) return u * kZiggurat.x[box];
    if (box == 0) {  // the tail, Marsaglia 1964
      double x, y;
      do {
        x = std::log(1 - uniform()) / kTail;
        y = std::log(1 - uniform());
      } while (-2 * y < x * x);
      return u < 0 ? x - kTail : kTail - x;
    }
    const double x = u * kZiggurat.x[box];
    const double f0 = std::exp(-0.5 * (kZiggurat.x[box] * kZiggurat.x[box] - x * x));
    const double f1 = std::exp(-0.5 * (kZiggurat.x[box + 1] * kZiggurat.x[box + 1] - x * x));
    if (f1 + uniform() * (f0 - f1) < 1) return x;
  }
}

std::uint64_t derived_seed(std::uint64_t seed, std::string_view name, std::uint64_t index) {
  std::uint64_t x = seed ^ fnv1a(name);
  const std::uint64_t a = split_mix(x);
  x = a ^ (index * 0xd1342543de82ef95ULL);
  return split_mix(x);
}

}  // namespace waverig
