// Spectrum of what is seen at the nodes of a time grid, and its split into sea and noise.
//
// The second difference of the double-integrated acceleration at nodes dt apart, x(k) = p(k+1) - 2 p(k) +
// p(k-1), needs no initial speed or position; it is dt^2 times the acceleration, weighted by a triangle over
// both intervals. Its density is exactly
//     X(f) = (2 - 2 cos w dt)^2 Z(f) + q dt^4 (2 + cos w dt) / 3
// with Z the density of heave sampled at the nodes (aliases and all; (2 - 2 cos w dt)^2 is w^4 dt^4 for slow
// waves) and q that of white acceleration noise. Densities here are two-sided, per Hz, at i / (block dt), i =
// 0 … block / 2.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>

#include "estimator/heave/path_integrator.h"

namespace waverig::estimator {

class RealTransform;

// x(k) of the node between two intervals.
inline double second_difference_m(const PathIncrement& before, const PathIncrement& after, double dt_s) {
  return dt_s * before.speed_mps + after.path_m - before.path_m;
}

// Its density under white acceleration noise, at the angles w dt.
inline Eigen::ArrayXd noise_density_m2s(const Eigen::ArrayXd& w_dt, double noise_m2ps3, double dt_s) {
  return noise_m2ps3 * std::pow(dt_s, 4) * (2 + w_dt.cos()) / 3;
}

// Periodograms of up to `block` values under a Hann window, zero-padded to `block`.
class Periodogram {
 public:
  explicit Periodogram(int block);
  ~Periodogram();
  Periodogram(const Periodogram&) = delete;
  Periodogram& operator=(const Periodogram&) = delete;

  // Density of values.front() … values.back() with their mean removed; 2 <= values.size() <= block.
  const Eigen::VectorXd& of(std::span<const double> values, double dt_s);
  static double window(std::size_t i, std::size_t n);  // Hann, without zeros at the ends

 private:
  std::unique_ptr<RealTransform> transform_;
  Eigen::VectorXd density_;
};

struct SeaAndNoise {
  Eigen::VectorXd heave_density_m2s;  // Z, zero below the sea's lowest frequency
  double noise_m2ps3 = 0;             // q, two-sided
  Eigen::Index first_bin = 0;         // of the sea
  bool found = false;                 // something stands out
  bool cut_off = false;               // and does so at the lowest frequency that the blocks resolve
};

// q is found where there is no sea: below the lowest frequency whose power stands out. Below lowest_hz the
// blocks resolve nothing and the sea is left at zero; where that reaches far into the frequencies of waves,
// nothing is seen of q either, and assumed_noise is taken. A floor far above assumed_noise, the sensor's, is
// no noise but slow motion, and stays with the sea.
SeaAndNoise split_sea_from_noise(const Eigen::VectorXd& density, double dt_s, double assumed_noise_m2ps3,
                                 double lowest_hz);

}  // namespace waverig::estimator
