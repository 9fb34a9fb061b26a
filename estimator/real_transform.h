// Fourier transform of one real series of any length, by FFTW. Any number of them in any number of threads:
// FFTW's planner, which serves one thread at a time in the whole process, is locked here and nowhere else.
#pragma once
#include <fftw3.h>

#include <complex>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>

namespace waverig::estimator {

class RealTransform {
 public:
  explicit RealTransform(std::size_t n)
      : n_(n), in_(fftw_alloc_real(n)), out_(fftw_alloc_complex(n / 2 + 1)) {
    const std::lock_guard lock(planner());
    plan_ = fftw_plan_dft_r2c_1d(static_cast<int>(n), in_.get(), out_.get(), FFTW_ESTIMATE);
  }
  ~RealTransform() {
    const std::lock_guard lock(planner());
    fftw_destroy_plan(plan_);
  }
  RealTransform(const RealTransform&) = delete;
  RealTransform& operator=(const RealTransform&) = delete;

  // Fill, execute, read [0, n / 2]: sum of x_i exp(-2 pi sqrt(-1) i k / n). The input survives.
  std::span<double> in() { return {in_.get(), n_}; }
  void execute() { fftw_execute(plan_); }
  std::complex<double> operator[](std::size_t k) const { return {out_.get()[k][0], out_.get()[k][1]}; }
  double power(std::size_t k) const { return std::norm((*this)[k]); }
  std::size_t frequencies() const { return n_ / 2 + 1; }

 private:
  struct Free {
    void operator()(void* memory) const { fftw_free(memory); }
  };
  static std::mutex& planner() {
    static std::mutex mutex;
    return mutex;
  }
  std::size_t n_;
  std::unique_ptr<double, Free> in_;
  std::unique_ptr<fftw_complex, Free> out_;
  fftw_plan plan_;
};

}  // namespace waverig::estimator
