#include "estimator/heave/wave_counter.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kBand = 2;           // sigmas
constexpr double kRemembered_s = 20;  // of the sea

}  // namespace

double WaveCounter::band_m(const HeaveSample& sample) {
  const double dt_s =
      has_last_ ? static_cast<double>(sample.utime - last_utime_) * kMicrosecond : kRemembered_s;
  mean_square_m2_ += (1 - std::exp(-dt_s / kRemembered_s)) * (square(sample.heave_m) - mean_square_m2_);
  const double whole_m = kBand * sample.heave_sigma_m, sea_m = std::sqrt(mean_square_m2_);
  return sea_m > whole_m ? whole_m * whole_m / sea_m : whole_m;
}

void WaveCounter::reach(double heave_m, double sigma_m) {
  if (heave_m > crest_m_) {
    crest_m_ = heave_m;
    crest_sigma_m_ = sigma_m;
  }
  if (heave_m < trough_m_) {
    trough_m_ = heave_m;
    trough_sigma_m_ = sigma_m;
  }
}

std::optional<Wave> WaveCounter::add(const HeaveSample& sample, double systematic_sigma_m,
                                     double tilt_sigma_rad) {
  const double h = sample.heave_m, band = band_m(sample);
  const double span_us = static_cast<double>(sample.utime - last_utime_);
  if (has_last_ && last_heave_m_ < 0 && h >= 0)
    crossing_utime_ = last_utime_ + std::llround(span_us * last_heave_m_ / (last_heave_m_ - h));
  const double sigma_m = std::sqrt(std::max(square(sample.heave_sigma_m) - square(systematic_sigma_m), 0.0));
  // Crest and trough lie between samples, where the rate is none; it goes in a straight line there.
  const double rate = sample.heave_rate_mps;
  const bool turned = has_last_ && last_rate_mps_ * rate < 0;
  const double turn_m = turned ? last_heave_m_ + span_us * kMicrosecond / 2 * last_rate_mps_ *
                                                     last_rate_mps_ / (last_rate_mps_ - rate)
                               : h;
  if (turned) reach(turn_m, sigma_m);
  std::optional<Wave> wave;
  if (h < -band) below_ = true;
  if (below_ && h > band) {
    below_ = false;
    wave = cross(tilt_sigma_rad);
  }
  reach(h, sigma_m);
  flags_ |= sample.flags;
  last_heave_m_ = h;
  last_rate_mps_ = rate;
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
