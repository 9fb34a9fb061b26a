#include "estimator/sample_guard.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr int kSettledChanges = 20;  // changes seen before a spike can be told from the motion
constexpr int kStep = 3;             // so many jumps in a row are a step, not a spike
constexpr double kForgotten = 5;     // intervals after which the last sample says nothing of the next
constexpr double kForget = 0.02;     // of the usual change, per sample
constexpr double kSlowest_s = 1;     // of intervals: before theirs is known, a longer one is a gap
constexpr int kNewRate = 10;         // so many gaps in a row are no gaps but a slower rate
constexpr double kFar_s = 60;        // ahead; a bad time stamp less far silences for no longer
constexpr std::int64_t kLatest_us = std::int64_t{1} << 62;  // so that no difference of times overflows

double median(const std::array<double, 3>& x) {
  return std::max(std::min(x[0], x[1]), std::min(std::max(x[0], x[1]), x[2]));
}

}  // namespace

bool SampleGuard::in_range(const ImuSample& s) const {
  return s.f_B.allFinite() && s.w_NB_B.allFinite() &&
         s.f_B.cwiseAbs().maxCoeff() <= settings_.accel_plausible_mps2 &&
         s.w_NB_B.cwiseAbs().maxCoeff() <= settings_.gyro_plausible_radps;
}

// A time far ahead of all before is believed once the next sample is of it too. A bad time stamp stands
// alone; believed, it would make stragglers of all that follow.
bool SampleGuard::far_ahead(std::int64_t utime) {
  const double far_s = std::max(kFar_s, kForgotten * interval_s_);
  const bool far = interval_s_ > 0 && static_cast<double>(utime - newest_utime_) * kMicrosecond > far_s;
  if (far && (!ahead_utime_ || utime <= *ahead_utime_)) {
    ahead_utime_ = utime;
    return true;
  }
  if (utime > newest_utime_) {  // else a straggler, which says nothing
    newest_utime_ = utime;
    ahead_utime_.reset();
  }
  return false;
}

bool SampleGuard::flat(const ImuSample& s) {
  if (s.f_B != flat_f_B_) {
    flat_f_B_ = s.f_B;
    flat_since_ = s.utime;
    return false;
  }
  return settings_.flat_line_s > 0 &&
         static_cast<double>(s.utime - flat_since_) * kMicrosecond >= settings_.flat_line_s;
}

bool SampleGuard::spike(const ImuSample& s) {
  const double change_mps2 = (s.f_B - last_f_B_).cwiseAbs().maxCoeff();
  const double change_radps = (s.w_NB_B - last_w_NB_B_).cwiseAbs().maxCoeff();
  const double ratio = settings_.spike_ratio;
  const bool jumps = change_mps2 > std::max(settings_.spike_floor_mps2, ratio * usual_change_mps2_) ||
                     change_radps > std::max(settings_.spike_floor_radps, ratio * usual_change_radps_);
  if (ratio > 0 && changes_ >= kSettledChanges && jumps && ++jumps_ < kStep) return true;
  if (jumps_ < kStep) {  // the change that ends a step says nothing of the usual one
    const double share = changes_ < kSettledChanges ? 1.0 / (changes_ + 1) : kForget;
    usual_change_mps2_ += share * (change_mps2 - usual_change_mps2_);
    usual_change_radps_ += share * (change_radps - usual_change_radps_);
    if (changes_ < kSettledChanges) ++changes_;
  }
  jumps_ = 0;
  return false;
}

// The median of the first three, of which one may be a gap or cut short; then their mean, and in the end a
// slow follower, gaps left out.
void SampleGuard::learn_interval(double dt_s, bool gap) {
  latest_s_ = {latest_s_[1], latest_s_[2], dt_s};
  gaps_ = gap ? gaps_ + 1 : 0;
  if (interval_s_ > 0 ? gaps_ < kNewRate : intervals_ + 1 < 3) {
    ++intervals_;
    if (interval_s_ > 0 && !gap) interval_s_ += (dt_s - interval_s_) / std::min(intervals_, 100);
    return;
  }
  interval_s_ = median(latest_s_);
  intervals_ = 3;
  gaps_ = 0;
}

GuardVerdict SampleGuard::check(const ImuSample& s) {
  GuardVerdict verdict{.usable = false, .flags = s.flags, .dt_s = 0, .anew = false};
  const bool dated = s.utime > -kLatest_us && s.utime < kLatest_us;
  const bool ahead = dated && far_ahead(s.utime);
  if (!dated || !in_range(s) || (started_ && s.utime <= last_utime_)) {
    verdict.flags |= flag::kRange;
    return verdict;
  }
  if (ahead) {
    verdict.flags |= flag::kGap;
    return verdict;
  }
  if (flat(s)) {
    verdict.flags |= flag::kFlatLine;
    return verdict;
  }
  const double dt_s = started_ ? static_cast<double>(s.utime - last_utime_) * kMicrosecond : 0.0;
  const bool gap = dt_s > (interval_s_ > 0 ? settings_.gap_ratio * interval_s_ : kSlowest_s);
  if (interval_s_ > 0 && dt_s > kForgotten * interval_s_) {
    jumps_ = 0;
  } else if (started_ && spike(s)) {
    verdict.flags |= flag::kSpike;
    return verdict;
  }
  if ((settings_.accel_limit_mps2 > 0 && s.f_B.cwiseAbs().maxCoeff() >= settings_.accel_limit_mps2) ||
      (settings_.gyro_limit_radps > 0 && s.w_NB_B.cwiseAbs().maxCoeff() >= settings_.gyro_limit_radps)) {
    verdict.flags |= flag::kSaturation;
  }
  if (gap) verdict.flags |= flag::kGap;
  if (started_) learn_interval(dt_s, gap);
  verdict.usable = true;
  verdict.dt_s = dt_s;
  verdict.anew = !started_ || (gap && dt_s > longest_bridge_s(interval_s_));
  started_ = true;
  last_utime_ = s.utime;
  last_f_B_ = s.f_B;
  last_w_NB_B_ = s.w_NB_B;
  return verdict;
}

}  // namespace waverig::estimator
