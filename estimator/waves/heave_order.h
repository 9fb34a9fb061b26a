// HeaveOrder: what a method that answers every sample, usable or not, tells of heave, in order of time.
//
// A sample whose time does not grow has no place in a series and is left out. So is a rejected one far ahead
// of all before, unless the next lies after it: a bad time stamp stands alone, and believed it would make
// stragglers of all that follow.
#pragma once
#include <optional>

#include "estimator/method.h"

namespace waverig::estimator {

class HeaveOrder {
 public:
  void give(const HeaveSample& heave, bool usable, Output& output) {
    if (doubtful_ && heave.utime > doubtful_->utime) tell(*doubtful_, output);
    doubtful_.reset();
    if (last_utime_ && heave.utime <= *last_utime_) return;
    if (usable || (last_utime_ && !far_ahead(heave.utime)))
      tell(heave, output);
    else
      doubtful_ = heave;
  }

 private:
  static constexpr double kFar_s = 60;

  // In floating point, since the time of a rejected sample may be any number.
  bool far_ahead(std::int64_t utime) const {
    return (static_cast<double>(utime) - static_cast<double>(*last_utime_)) * kMicrosecond > kFar_s;
  }
  void tell(const HeaveSample& heave, Output& output) {
    last_utime_ = heave.utime;
    output.heave(heave);
  }

  std::optional<std::int64_t> last_utime_;  // of the heave told last
  std::optional<HeaveSample> doubtful_;
};

}  // namespace waverig::estimator
