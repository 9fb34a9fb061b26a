#include "rig/campaign/sea_bound.h"

#include <cmath>

namespace waverig::rig {
namespace {

constexpr double kNodesAPeriod = 40;  // of the peak, at least

}  // namespace

evaluation::HeaveBound sea_bound(const motion::SeaSettings& sea, const AccelerometerSettings& accelerometer) {
  const motion::WaveSpectrum spectrum(sea.shape, sea.hm0_m, sea.tp_s, sea.gamma);
  const double lowest_hz = sea.lowest_relative * spectrum.peak_Hz(),
               highest_hz = sea.highest_relative * spectrum.peak_Hz();
  const auto drawn = [=](double f_hz) {
    return f_hz >= lowest_hz && f_hz <= highest_hz ? spectrum.density(f_hz) : 0.0;
  };
  // A power of two, so that lags of half a second and more are whole intervals.
  return evaluation::HeaveBound({.density_m2_per_hz = drawn,
                                 .noise_density_mps2_rthz = accelerometer.noise_density_mps2,
                                 .interval_s = std::exp2(std::floor(std::log2(sea.tp_s / kNodesAPeriod))),
                                 .instability_sigma_mps2 = accelerometer.instability_sigma_mps2,
                                 .instability_time_s = accelerometer.instability_time_s});
}

double heave_lag_s(const std::string& method, double fixed_lag_s) {
  return method == "realtime" ? fixed_lag_s : evaluation::kWholeRecord_s;
}

}  // namespace waverig::rig
