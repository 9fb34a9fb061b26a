#include "estimator/heave/node_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/real_transform.h"

namespace waverig::estimator {
namespace {

constexpr double kStandsOut = 12;  // times the least level, itself below the noise by chance: there is sea
constexpr double kSeesNoise_hz = 0.025;  // blocks of 100 s
constexpr double kLowestSea_hz = 0.02;   // longer waves are no wind sea nor swell
constexpr double kLeastNoise = 0.05;     // of what was assumed
constexpr double kLeastQuiet = 0.7;      // of what was assumed, to tell sea from
constexpr double kMostNoise = 3;         // of what was assumed: what is more is slow motion
constexpr double kQuiet_hz = 0.12;       // somewhere below it there is no sea

}  // namespace

Periodogram::Periodogram(int block)
    : transform_(std::make_unique<RealTransform>(static_cast<std::size_t>(block))), density_(block / 2 + 1) {}

Periodogram::~Periodogram() = default;

double Periodogram::window(std::size_t i, std::size_t n) {
  return 1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
}

const Eigen::VectorXd& Periodogram::of(std::span<const double> values, double dt_s) {
  double mean = 0, power = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  const std::span<double> in = transform_->in();
  std::fill(in.begin(), in.end(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double w = window(i, values.size());
    in[i] = w * (values[i] - mean);
    power += w * w;
  }
  transform_->execute();
  for (Eigen::Index i = 0; i < density_.size(); ++i)
    density_[i] = dt_s * transform_->power(static_cast<std::size_t>(i)) / power;
  return density_;
}

SeaAndNoise split_sea_from_noise(const Eigen::VectorXd& density, double dt_s, double assumed_noise_m2ps3,
                                 double lowest_hz) {
  const Eigen::Index bins = density.size();
  const double step = std::numbers::pi / static_cast<double>(bins - 1),
               df_hz = step / (2 * std::numbers::pi * dt_s);
  const Eigen::VectorXd noise =  // of unit q
      noise_density_m2s(step * Eigen::ArrayXd::LinSpaced(bins, 0, static_cast<double>(bins - 1)), 1, dt_s);
  Eigen::VectorXd level(bins);  // X in terms of q, lightly smoothed
  const Eigen::VectorXd raw = density.cwiseQuotient(noise);
  for (Eigen::Index i = 0; i < bins; ++i) {
    const Eigen::Index a = std::max<Eigen::Index>(i - 1, 1), b = std::min(i + 1, bins - 1);
    level[i] = raw.segment(a, b - a + 1).mean();
  }
  const auto bin_of = [&](double f_hz) {
    return std::clamp<Eigen::Index>(std::lround(f_hz / df_hz), 2, bins - 2);
  };
  const Eigen::Index resolved = bin_of(lowest_hz), quiet_end = bin_of(kQuiet_hz);
  const bool sees_noise = lowest_hz < kSeesNoise_hz;
  const auto plausible = [&](double noise_m2ps3) {
    return std::clamp(noise_m2ps3, kLeastNoise * assumed_noise_m2ps3, kMostNoise * assumed_noise_m2ps3);
  };
  // The least of some levels is less than the noise, by chance: no reason to see a sea in the others.
  // A short record resolves nothing below the quiet end: there is no such level, and it is not asked for.
  const double quiet = sees_noise
                           ? std::max(plausible(level.segment(resolved, quiet_end - resolved).minCoeff()),
                                      kLeastQuiet * assumed_noise_m2ps3)
                           : assumed_noise_m2ps3;
  const auto stands_out = [&](Eigen::Index i) { return level[i] > kStandsOut * quiet; };
  Eigen::Index first = std::max(bin_of(kLowestSea_hz), resolved + 1);
  while (first < bins - 1 && !(stands_out(first) && stands_out(first + 1))) ++first;

  SeaAndNoise split;
  split.first_bin = std::max(first - 1, resolved);
  split.found = first < bins - 1;
  split.cut_off = first == resolved + 1;
  split.noise_m2ps3 = assumed_noise_m2ps3;
  if (sees_noise && resolved < split.first_bin)
    split.noise_m2ps3 = plausible(raw.segment(resolved, split.first_bin - resolved).mean());
  split.heave_density_m2s.setZero(bins);
  for (Eigen::Index i = split.first_bin; i < bins; ++i)
    split.heave_density_m2s[i] = std::max(density[i] - split.noise_m2ps3 * noise[i], 0.0) /
                                 std::pow(2 - 2 * std::cos(step * static_cast<double>(i)), 2);
  return split;
}

}  // namespace waverig::estimator
