#include "estimator/heave/calm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace waverig::estimator {
namespace {

constexpr std::ptrdiff_t kApart = 4;  // steps from one moment to the next
constexpr std::ptrdiff_t kMoments = 24;
constexpr std::int64_t kReach = 3 * kApart;  // steps to the moments beside one
constexpr std::int64_t kLong = 40;   // steps, after which speed and bias are known well enough to begin from
constexpr double kDriftsAway = 4;    // standard deviations of the drift's speed
constexpr double kFarthestRest = 2;  // standard deviations of the sea, from its mean level

}  // namespace

HeaveFilter Calm::risen(const Since& since, const SeaModel& sea, double level_m) {
  HeaveFilter filter = since.filter;
  const bool as_before = std::abs(level_m) < kFarthestRest * std::sqrt(sea.heave_variance_m2());
  filter.begin_sea(sea, as_before ? level_m : 0.0);
  for (const HeaveStep& step : since.steps) filter.step(step);
  return filter;
}

void Calm::clear() {
  since_.clear();
  lasts_ = 0;
}

void Calm::add(const HeaveFilter& before, const HeaveStep& step) {
  if (since_.empty() || std::ssize(since_.back().steps) >= kApart) since_.push_back({before, {}, lasts_});
  if (std::ssize(since_) > kMoments) since_.pop_front();
  ++lasts_;
  follow(step);
}

void Calm::follow(const HeaveStep& step) {
  for (Since& since : since_) since.steps.push_back(step);
}

bool Calm::is_long() const { return !since_.empty() && since_.back().at >= kLong; }

const Calm::Since* Calm::onset(const SeaModel& sea, double level_m, double log_likelihood,
                               const Since* beside) const {
  const Since* onset = nullptr;
  for (const Since& since : since_) {
    const std::int64_t away = beside ? std::abs(since.at - beside->at) : kApart;
    if (since.at < kLong || away == 0 || away > kReach) continue;
    const HeaveFilter filter = risen(since, sea, level_m);
    if (filter.rest_s() > 0 || filter.log_likelihood() <= log_likelihood) continue;
    onset = &since;
    log_likelihood = filter.log_likelihood();
  }
  return onset;
}

bool Calm::drifts_away(const HeaveFilter& now) const {
  return std::any_of(since_.begin(), since_.end(), [&](const Since& since) {
    if (since.at < kLong) return false;
    const double elapsed_s = static_cast<double>(std::ssize(since.steps)) * kFineInterval_s;
    return now.drifted_from(since.filter, elapsed_s) > kDriftsAway;
  });
}

}  // namespace waverig::estimator
