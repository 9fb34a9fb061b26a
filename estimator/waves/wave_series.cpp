#include "estimator/waves/wave_series.h"

#include <algorithm>

namespace waverig::estimator {

void WaveSeries::add(const LevelledSample& sample) {
  if (!sample.usable) return;
  const auto index = static_cast<std::int64_t>(std::floor(sample.t_s / kBin_s));
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
  const auto it = std::lower_bound(bins_.begin(), bins_.end(), t_s,
                                   [](const Bin& bin, double t) { return bin.t_s < t; });
  return static_cast<std::size_t>(it - bins_.begin());
}

}  // namespace waverig::estimator
