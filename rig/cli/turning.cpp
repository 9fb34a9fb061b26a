#include "rig/cli/turning.h"

#include <algorithm>
#include <cmath>

namespace waverig::cli {
namespace {

constexpr double kWindow_s = 0.25;  // short against a turn, long against the noise of the specific force
constexpr double kWild_radps = 2;
constexpr double kSeen = 0.25;

}  // namespace

void Turning::add(const estimator::ImuSample& sample) {
  const Vector3d direction = sample.f_B.normalized();
  const double dt_s = static_cast<double>(sample.utime - last_utime_) * kMicrosecond;
  if (last_utime_ == 0 || dt_s > kWindow_s) {  // the first one, or the first after a gap
    begin_utime_ = sample.utime;
    begin_ = direction;
    told_.setZero();
  } else {
    // A direction that stands in the world turns against the body.
    told_ -= dt_s * sample.w_NB_B.cross(direction);
  }
  last_utime_ = sample.utime;
  const double window_s = static_cast<double>(sample.utime - begin_utime_) * kMicrosecond;
  if (window_s < kWindow_s) return;
  const Vector3d told_radps = told_ / window_s;
  sum_radps_ += told_radps;
  told_squares_ += told_radps.squaredNorm();
  seen_squares_ += (direction - begin_).squaredNorm() / (window_s * window_s);
  ++count_;
  begin_utime_ = sample.utime;
  begin_ = direction;
  told_.setZero();
}

double Turning::told_radps() const {
  if (count_ == 0) return 0;
  const auto n = static_cast<double>(count_);
  return std::sqrt(std::max(0.0, told_squares_ / n - (sum_radps_ / n).squaredNorm()));
}

double Turning::seen_radps() const {
  return count_ == 0 ? 0 : std::sqrt(seen_squares_ / static_cast<double>(count_));
}

bool Turning::contradicts_itself() const {
  return told_radps() > kWild_radps && seen_radps() < kSeen * told_radps();
}

}  // namespace waverig::cli
