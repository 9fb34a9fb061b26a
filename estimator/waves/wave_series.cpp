#include "estimator/waves/wave_series.h"

#include <algorithm>

namespace waverig::estimator {

void WaveSeries::set_sample_interval(double interval_s) {
  if (started_ || interval_s <= 0) return;
  constexpr double kAbout_s = 0.05;
  bin_s_ = std::max(1.0, std::round(kAbout_s / interval_s)) * interval_s;
  half_sample_s_ = 0.5 * interval_s;  // so that no sample falls on a bin's edge
}

void WaveSeries::add(const LevelledSample& sample) {
  if (!sample.usable) return;
  started_ = true;
  const auto index = static_cast<std::int64_t>(std::floor((sample.t_s + half_sample_s_) / bin_s_));
  if (bins_.empty() || bins_.back().index != index) {
    Bin bin;
    bin.index = index;
    bin.q_NB = sample.q_NB;
    bins_.push_back(bin);
  }
  Bin& bin = bins_.back();
  bin.count += 1;
  const double k = 1 / bin.count, dt = sample.t_s - bin.t_s;
  bin.var_t_s2 = (1 - k) * (bin.var_t_s2 + k * dt * dt);
  bin.t_s += k * dt;
  bin.up_mps2 += k * (sample.up_mps2 - bin.up_mps2);
  bin.f_B += k * (sample.f_B - bin.f_B);
}

void WaveSeries::drop_before(double t_s) {
  while (!bins_.empty() && bins_.front().t_s < t_s) bins_.pop_front();
}

std::size_t WaveSeries::lower_bound(double t_s) const {
  const auto it =
      std::lower_bound(bins_.begin(), bins_.end(), t_s, [](const Bin& bin, double t) { return bin.t_s < t; });
  return static_cast<std::size_t>(it - bins_.begin());
}

}  // namespace waverig::estimator
