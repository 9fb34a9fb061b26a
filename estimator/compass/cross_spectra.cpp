#include "estimator/compass/cross_spectra.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

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

}  // namespace

// Real transform of any length. FFTW plans are the one thing in it that threads may not make at the same
// time.
class RealTransform {
 public:
  explicit RealTransform(std::size_t n)
      : n_(n), in_(fftw_alloc_real(n)), out_(fftw_alloc_complex(n / 2 + 1)) {
    const std::lock_guard lock(mutex());
    plan_ = fftw_plan_dft_r2c_1d(static_cast<int>(n), in_, out_, FFTW_ESTIMATE);
  }
  ~RealTransform() {
    const std::lock_guard lock(mutex());
    fftw_destroy_plan(plan_);
    fftw_free(in_);
    fftw_free(out_);
  }
  RealTransform(const RealTransform&) = delete;
  RealTransform& operator=(const RealTransform&) = delete;

  std::vector<Complex> operator()(const std::vector<double>& x) {
    std::copy(x.begin(), x.end(), in_);
    fftw_execute(plan_);
    std::vector<Complex> result(n_ / 2 + 1);
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = {out_[k][0], out_[k][1]};
    return result;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::size_t n_;
  double* in_;
  fftw_complex* out_;
  fftw_plan plan_;
};

std::vector<double> hann_window(std::size_t n) {
  std::vector<double> window(n);
  for (std::size_t i = 0; i < n; ++i)
    window[i] =
        std::sqrt(2.0 / 3) * (1 - std::cos(kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
  return window;
}

void soften_ends(std::vector<double>& window, std::size_t bins, bool at_start, bool at_end) {
  for (std::size_t i = 0; i < bins; ++i) {
    const double s = std::sin(0.25 * kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(bins));
    if (at_start) window[i] *= s * s;
    if (at_end) window[window.size() - 1 - i] *= s * s;
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
  const std::vector<Complex> z = (*transform_)(up), n = (*transform_)(north), e = (*transform_)(east);
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
