#include "estimator/evaluation/even_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waverig::evaluation {

Interpolated::Interpolated(std::span<const std::int64_t> utime, std::span<const double> value) {
  for (std::size_t i = 0; i < utime.size(); ++i) {
    if (!std::isfinite(value[i])) continue;
    utime_.push_back(utime[i]);
    value_.push_back(value[i]);
  }
}

double Interpolated::at(std::int64_t utime) {
  while (next_ + 1 < utime_.size() && utime_[next_] < utime) ++next_;
  bridged_ = 0;
  if (next_ == 0 || utime >= utime_[next_]) return value_[next_];
  bridged_ = utime_[next_] - utime_[next_ - 1];
  const double x =
      static_cast<double>(utime - utime_[next_ - 1]) / static_cast<double>(utime_[next_] - utime_[next_ - 1]);
  return value_[next_ - 1] + x * (value_[next_] - value_[next_ - 1]);
}

std::int64_t median_interval(std::span<const std::int64_t> utime) {
  std::vector<std::int64_t> interval;
  for (std::size_t i = 1; i < utime.size(); ++i) interval.push_back(utime[i] - utime[i - 1]);
  const auto middle = interval.begin() + static_cast<std::ptrdiff_t>(interval.size() / 2);
  std::nth_element(interval.begin(), middle, interval.end());
  return *middle;
}

std::int64_t longest_step(std::span<const std::int64_t> utime) {
  constexpr std::int64_t kSteps = 3;
  return kSteps * std::min(median_interval(utime), std::numeric_limits<std::int64_t>::max() / kSteps);
}

std::vector<std::vector<double>> even_pieces(std::span<const std::int64_t> utime,
                                             std::span<const double> value) {
  std::vector<std::vector<double>> pieces;
  if (utime.size() < 2) return pieces;
  const std::int64_t step = median_interval(utime), longest = longest_step(utime);
  if (step <= 0) return pieces;
  std::size_t first = 0, last = utime.size();  // known values of the piece that is being gathered
  const auto close = [&] {
    if (last == utime.size()) return;
    Interpolated piece(utime.subspan(first, last + 1 - first), value.subspan(first, last + 1 - first));
    auto& even = pieces.emplace_back();
    for (std::int64_t t = piece.begin(); t <= piece.end(); t += step) even.push_back(piece.at(t));
  };
  for (std::size_t i = 0; i < utime.size(); ++i) {
    if (!std::isfinite(value[i])) continue;
    if (last == utime.size() || utime[i] - utime[last] > longest) {
      close();
      first = i;
    }
    last = i;
  }
  close();
  return pieces;
}

bool mostly_gap(std::int64_t begin, std::int64_t end, std::int64_t step, std::size_t known) {
  constexpr double kStepsPerValue = 100;
  return (static_cast<double>(end) - static_cast<double>(begin)) / static_cast<double>(step) >
         kStepsPerValue * static_cast<double>(known);
}

}  // namespace waverig::evaluation
