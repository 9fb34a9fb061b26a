// Averaged cross-spectra of three real series, by windowed Fourier transforms: the machinery under
// directional.h.
#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace waverig::estimator {

// Windows of unit mean square, each three quarters overlapped by the next.
inline constexpr std::size_t kHannSteps = 4;
std::vector<double> hann_window(std::size_t n);

// Rises over the first and falls over the last bins of a window.
void soften_ends(std::vector<double>& window, std::size_t bins);

class RealTransform;

// Sums over segments of one-sided densities times window weight; divide by weight(). S_xy = E[X* Y].
class CrossSpectra {
 public:
  // n: length of every segment.
  explicit CrossSpectra(std::size_t n, double step_s);
  ~CrossSpectra();

  // Takes offset and trend off each series, applies the window, transforms and adds.
  void add(std::vector<double> z, std::vector<double> n, std::vector<double> e,
           const std::vector<double>& window);

  std::size_t length() const { return n_; }
  std::size_t frequencies() const { return n_ / 2 + 1; }
  double step_Hz() const { return 1 / (step_s_ * static_cast<double>(n_)); }
  double weight() const { return weight_; }  // sum of the windows' mean squares

  std::vector<double> zz, nn, ee;
  std::vector<std::complex<double>> zn, ze, ne;

 private:
  std::size_t n_;
  double step_s_, weight_ = 0;
  std::unique_ptr<RealTransform> transform_;
};

}  // namespace waverig::estimator
