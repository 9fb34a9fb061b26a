// An unevenly sampled series on an even grid.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace waverig::evaluation {

// Straight lines between the known (finite) values of a series, read at growing times.
class Interpolated {
 public:
  // Both spans must outlive it. utime grows.
  Interpolated(std::span<const std::int64_t> utime, std::span<const double> value);
  std::size_t known() const { return utime_.size(); }
  std::int64_t begin() const { return utime_.front(); }
  std::int64_t end() const { return utime_.back(); }
  // utime: not before that of the last call; held constant outside of the series.
  double at(std::int64_t utime);
  // Between the two known values that the last call stood between; 0 on a known value and outside.
  std::int64_t bridged() const { return bridged_; }

 private:
  std::vector<std::int64_t> utime_;
  std::vector<double> value_;
  std::size_t next_ = 0;
  std::int64_t bridged_ = 0;
};

// utime: at least two, growing.
std::int64_t median_interval(std::span<const std::int64_t> utime);

// Two values further apart than this have a gap between them: three times the median interval.
std::int64_t longest_step(std::span<const std::int64_t> utime);

// The pieces of a series between its gaps, each on an even grid of the median interval from its first known
// value on; none where that interval is not positive, times that do not grow being no series. Single values
// that are unknown or missing are no gap: straight lines stand for them.
std::vector<std::vector<double>> even_pieces(std::span<const std::int64_t> utime,
                                             std::span<const double> value);

// An even grid over [begin, end] would be mostly gap: a hundred steps and more for each value that is known.
bool mostly_gap(std::int64_t begin, std::int64_t end, std::int64_t step, std::size_t known);

}  // namespace waverig::evaluation
