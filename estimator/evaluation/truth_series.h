// The true motion of one run, kept as long as the run lasts and read between its samples.
#pragma once
#include <cstdint>
#include <vector>

#include "estimator/types.h"

namespace waverig::evaluation {

class TruthSeries {
 public:
  // Samples that are not newer than the last one, or not finite, are left out. horizontal_m: north, east.
  void add(std::int64_t utime, double heave_m, double heave_rate_mps,
           const Eigen::Vector2d& horizontal_m = Eigen::Vector2d::Zero());

  struct Point {
    double heave_m = estimator::kUnknown, heave_rate_mps = estimator::kUnknown;
  };
  // Cubic Hermite between the neighbours; NaN outside of the series. Cheap where times grow from call to
  // call.
  Point at(std::int64_t utime) const;

  // North and east, linear between the neighbours; NaN outside of the series.
  Eigen::Vector2d horizontal_m(std::int64_t utime) const;

  // Crest to trough of the true heave over [begin, end], extremes between the samples included; NaN where the
  // series does not cover the span.
  double height_m(std::int64_t begin_utime, std::int64_t end_utime) const;

  bool empty() const { return samples_.empty(); }
  std::int64_t last_utime() const { return samples_.back().utime; }
  std::size_t size() const { return samples_.size(); }
  std::int64_t utime(std::size_t i) const { return samples_[i].utime; }
  Point point(std::size_t i) const { return {samples_[i].heave_m, samples_[i].heave_rate_mps}; }

 private:
  struct Sample {
    std::int64_t utime;
    double heave_m, heave_rate_mps, north_m, east_m;
  };
  // Index of the first sample at or after utime.
  std::size_t lower_bound(std::int64_t utime) const;

  std::vector<Sample> samples_;
  mutable std::size_t hint_ = 0;
};

}  // namespace waverig::evaluation
