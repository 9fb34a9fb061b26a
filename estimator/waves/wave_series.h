// WaveSeries: levelled samples gathered into short bins: what waves are found in and fitted to.
//
// A bin keeps the mean time and the spread of its samples' times, so that a harmonic can be averaged over it
// as the samples were, gaps and jitter included: the mean of cos(w t) over a bin is cos(w mean_t) (1 - w^2
// var_t / 2) to within (w bin)^4 / 1920, 1e-5 for a wave of one second.
#pragma once
#include <cmath>
#include <cstdint>
#include <deque>

#include "estimator/waves/block_leveller.h"

namespace waverig::estimator {

struct Bin {
  std::int64_t index = 0;  // of the bin interval it lies in
  double t_s = 0;          // mean time of its samples
  double var_t_s2 = 0;     // mean square deviation from it
  double count = 0;
  double up_mps2 = 0;  // means
  Vector3d f_B = Vector3d::Zero();
  Quaterniond q_NB = Quaterniond::Identity();  // of the first sample

  double attenuation(double w_radps) const { return 1 - 0.5 * w_radps * w_radps * var_t_s2; }
};

class WaveSeries {
 public:
  // Bins of whole samples, about a twentieth of a second long. Before the first add(); later calls are
  // ignored.
  void set_sample_interval(double interval_s);
  void add(const LevelledSample& sample);  // unusable samples are left out
  void drop_before(double t_s);

  const std::deque<Bin>& bins() const { return bins_; }
  bool empty() const { return bins_.empty(); }
  double begin_s() const { return bins_.empty() ? 0 : bins_.front().t_s; }
  double end_s() const { return bins_.empty() ? 0 : bins_.back().t_s; }
  double bin_s() const { return bin_s_; }
  std::size_t lower_bound(double t_s) const;  // first bin not before t_s

 private:
  std::deque<Bin> bins_;
  double bin_s_ = 0.05, half_sample_s_ = 0;
  bool started_ = false;
};

// What a series shows of one span of time, as indices into its bins.
struct BinRange {
  std::size_t first = 0, last = 0;  // [first, last)
  std::size_t size() const { return last - first; }
};

inline BinRange range_of(const WaveSeries& series, double begin_s, double end_s) {
  return {series.lower_bound(begin_s), series.lower_bound(end_s)};
}

}  // namespace waverig::estimator
