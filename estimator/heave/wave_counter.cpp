#include "estimator/heave/wave_counter.h"

#include <cmath>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kDeadBandSigmas = 2;

}  // namespace

std::optional<Wave> WaveCounter::add(const HeaveSample& sample, double tilt_sigma_rad) {
  const double h = sample.heave_m, band = kDeadBandSigmas * sample.heave_sigma_m;
  if (has_last_ && last_heave_m_ < 0 && h >= 0) {
    const double span_us = static_cast<double>(sample.utime - last_utime_);
    crossing_utime_ = last_utime_ + std::llround(span_us * last_heave_m_ / (last_heave_m_ - h));
  }
  std::optional<Wave> wave;
  if (h < -band) below_ = true;
  if (below_ && h > band) {
    below_ = false;
    wave = cross(tilt_sigma_rad);
  }
  if (h > crest_m_) {
    crest_m_ = h;
    crest_sigma_m_ = sample.heave_sigma_m;
  }
  if (h < trough_m_) {
    trough_m_ = h;
    trough_sigma_m_ = sample.heave_sigma_m;
  }
  flags_ |= sample.flags;
  last_heave_m_ = h;
  last_utime_ = sample.utime;
  has_last_ = true;
  return wave;
}

std::optional<Wave> WaveCounter::cross(double tilt_sigma_rad) {
  std::optional<Wave> wave;
  if (has_start_) {
    wave.emplace();
    wave->start_utime = start_utime_;
    wave->seq = seq_++;
    wave->period_s = static_cast<double>(crossing_utime_ - start_utime_) * kMicrosecond;
    wave->height_m = crest_m_ - trough_m_;
    wave->noise_sigma_m = std::hypot(crest_sigma_m_, trough_sigma_m_);
    wave->calibration_sigma_m = sensor_.wave_scale_sigma() * wave->height_m;
    wave->tilt_sigma_m =
        tilt_sigma_rad * wave->height_m;  // a_h errs into a_z; the path is about as wide as high
    wave->frequency_sigma_m = 0;          // no wave form is assumed
    wave->flags = flags_;
  }
  start_utime_ = crossing_utime_;
  has_start_ = true;
  crest_m_ = trough_m_ = 0;
  flags_ = 0;
  return wave;
}

}  // namespace waverig::estimator
