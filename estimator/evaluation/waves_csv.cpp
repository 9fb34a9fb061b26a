#include "estimator/evaluation/waves_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "lcmtypes/atomic_file.h"

namespace waverig::evaluation {

double combined_sigma_m(const estimator::Wave& wave) {
  double variance = 0;
  bool known = false;
  for (const double sigma :
       {wave.noise_sigma_m, wave.calibration_sigma_m, wave.tilt_sigma_m, wave.frequency_sigma_m}) {
    if (!std::isfinite(sigma)) continue;
    variance += sigma * sigma;
    known = true;
  }
  return known ? std::sqrt(variance) : estimator::kUnknown;
}

std::string waves_csv(std::span<const estimator::Wave> waves) {
  std::string text = "start_utime,period_s,height_cm,sigma_cm\n";
  for (const estimator::Wave& wave : waves) {
    const double sigma_m = combined_sigma_m(wave);
    text += fmt::format("{},{:.4f},{:.4f},", wave.start_utime, wave.period_s, wave.height_m / kCentimetre);
    text += std::isnan(sigma_m) ? std::string("\n") : fmt::format("{:.4f}\n", sigma_m / kCentimetre);
  }
  return text;
}

void write_waves_csv(const std::filesystem::path& path, std::span<const estimator::Wave> waves) {
  write_atomically(path, waves_csv(waves));
}

}  // namespace waverig::evaluation
