#include "estimator/evaluation/truth_series.h"

#include <algorithm>
#include <cmath>

namespace waverig::evaluation {

void TruthSeries::add(std::int64_t utime, double heave_m, double heave_rate_mps,
                      const Eigen::Vector2d& horizontal_m) {
  if (!samples_.empty() && utime <= samples_.back().utime) return;
  if (!std::isfinite(heave_m) || !std::isfinite(heave_rate_mps)) return;
  samples_.push_back({utime, heave_m, heave_rate_mps, horizontal_m.x(), horizontal_m.y()});
}

std::size_t TruthSeries::lower_bound(std::int64_t utime) const {
  constexpr std::size_t kNear = 16;
  std::size_t i = std::min(hint_, samples_.size());
  if (i == 0 || samples_[i - 1].utime < utime) {
    const std::size_t stop = std::min(samples_.size(), i + kNear);
    while (i < stop && samples_[i].utime < utime) ++i;
    if (i < stop) return hint_ = i;
  }
  const auto at = std::lower_bound(samples_.begin(), samples_.end(), utime,
                                   [](const Sample& s, std::int64_t t) { return s.utime < t; });
  return hint_ = static_cast<std::size_t>(at - samples_.begin());
}

TruthSeries::Point TruthSeries::at(std::int64_t utime) const {
  const std::size_t i = lower_bound(utime);
  if (i == samples_.size()) return {};
  const Sample& b = samples_[i];
  if (b.utime == utime) return {b.heave_m, b.heave_rate_mps};
  if (i == 0) return {};
  const Sample& a = samples_[i - 1];
  const double h = static_cast<double>(b.utime - a.utime) * kMicrosecond;
  const double x = static_cast<double>(utime - a.utime) * kMicrosecond / h;
  const double rise = b.heave_m - a.heave_m;
  const double c2 = 3 * rise - h * (2 * a.heave_rate_mps + b.heave_rate_mps);
  const double c3 = h * (a.heave_rate_mps + b.heave_rate_mps) - 2 * rise;
  return {a.heave_m + x * (h * a.heave_rate_mps + x * (c2 + x * c3)),
          a.heave_rate_mps + x * (2 * c2 + 3 * x * c3) / h};
}

Eigen::Vector2d TruthSeries::horizontal_m(std::int64_t utime) const {
  const std::size_t i = lower_bound(utime);
  if (i == samples_.size() || (i == 0 && samples_[0].utime != utime))
    return Eigen::Vector2d::Constant(estimator::kUnknown);
  const Sample &b = samples_[i], &a = samples_[i == 0 ? 0 : i - 1];
  if (b.utime == utime) return {b.north_m, b.east_m};
  const double x = static_cast<double>(utime - a.utime) / static_cast<double>(b.utime - a.utime);
  return {a.north_m + x * (b.north_m - a.north_m), a.east_m + x * (b.east_m - a.east_m)};
}

double TruthSeries::height_m(std::int64_t begin_utime, std::int64_t end_utime) const {
  const Point first = at(begin_utime), last = at(end_utime);
  if (!std::isfinite(first.heave_m) || !std::isfinite(last.heave_m)) return estimator::kUnknown;
  double high = std::max(first.heave_m, last.heave_m), low = std::min(first.heave_m, last.heave_m);
  // Where the rate changes sign between two samples an extreme lies between them; the rate is near straight
  // there.
  std::int64_t previous_utime = begin_utime;
  Point previous = first;
  const auto take = [&](std::int64_t utime, const Point& p) {
    if (previous.heave_rate_mps * p.heave_rate_mps < 0) {
      const double x = previous.heave_rate_mps / (previous.heave_rate_mps - p.heave_rate_mps);
      const double between =
          at(previous_utime + std::llround(x * static_cast<double>(utime - previous_utime))).heave_m;
      high = std::max(high, between);
      low = std::min(low, between);
    }
    high = std::max(high, p.heave_m);
    low = std::min(low, p.heave_m);
    previous = p;
    previous_utime = utime;
  };
  for (std::size_t i = lower_bound(begin_utime); i < samples_.size() && samples_[i].utime < end_utime; ++i)
    take(samples_[i].utime, point(i));
  take(end_utime, last);
  return high - low;
}

}  // namespace waverig::evaluation
