#include "estimator/compass/cross_spectra.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/real_transform.h"

namespace waverig::estimator {
namespace {

using Complex = std::complex<double>;
constexpr double kTurn = 2 * std::numbers::pi;

// Offset and trend are no waves.
void detrend_and_taper(std::vector<double>& x, const std::vector<double>& window) {
  const double n = static_cast<double>(x.size()), middle = 0.5 * (n - 1);
  double mean = 0, slope = 0, square = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    mean += x[i] / n;
    slope += t * x[i];
    square += t * t;
  }
  slope /= square;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = window[i] * (x[i] - mean - slope * (static_cast<double>(i) - middle));
}

std::vector<Complex> transformed(RealTransform& transform, const std::vector<double>& x) {
  std::copy(x.begin(), x.end(), transform.in().begin());
  transform.execute();
  std::vector<Complex> result(transform.frequencies());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = transform[k];
  return result;
}

}  // namespace

std::vector<double> hann_window(std::size_t n) {
  std::vector<double> window(n);
  for (std::size_t i = 0; i < n; ++i)
    window[i] =
        std::sqrt(2.0 / 3) * (1 - std::cos(kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
  return window;
}

void soften_ends(std::vector<double>& window, std::size_t bins) {
  for (std::size_t i = 0; i < bins; ++i) {
    const double s = std::sin(0.25 * kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(bins));
    window[i] *= s * s;
    window[window.size() - 1 - i] *= s * s;
  }
}

CrossSpectra::CrossSpectra(std::size_t n, double step_s)
    : zz(n / 2 + 1),
      nn(n / 2 + 1),
      ee(n / 2 + 1),
      zn(n / 2 + 1),
      ze(n / 2 + 1),
      ne(n / 2 + 1),
      n_(n),
      step_s_(step_s),
      transform_(std::make_unique<RealTransform>(n)) {}

CrossSpectra::~CrossSpectra() = default;

void CrossSpectra::add(std::vector<double> up, std::vector<double> north, std::vector<double> east,
                       const std::vector<double>& window) {
  for (auto* x : {&up, &north, &east}) detrend_and_taper(*x, window);
  const std::vector<Complex> z = transformed(*transform_, up), n = transformed(*transform_, north),
                             e = transformed(*transform_, east);
  const double density = 2 * step_s_ / static_cast<double>(n_);
  for (std::size_t k = 0; k < z.size(); ++k) {
    zz[k] += density * std::norm(z[k]);
    nn[k] += density * std::norm(n[k]);
    ee[k] += density * std::norm(e[k]);
    zn[k] += density * std::conj(z[k]) * n[k];
    ze[k] += density * std::conj(z[k]) * e[k];
    ne[k] += density * std::conj(n[k]) * e[k];
  }
  for (const double w : window) weight_ += w * w / static_cast<double>(n_);
}

}  // namespace waverig::estimator
