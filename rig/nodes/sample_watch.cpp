#include "rig/nodes/sample_watch.h"

#include <fmt/format.h>

#include "lcmtypes/flags.h"

namespace waverig::rig {
namespace {

constexpr int kSetBack = 3;  // so many late samples in order are a clock set back, not stragglers

}  // namespace

void SampleWatch::begin_record() {
  guard_ = estimator::SampleGuard();
  last_utime_.reset();
  late_in_a_row_ = 0;
}

void SampleWatch::add(const estimator::ImuSample& sample) {
  ++samples_;
  const double usual_s = guard_.usual_interval_s();
  const estimator::GuardVerdict verdict = guard_.check(sample);
  const std::int32_t found = verdict.flags & ~sample.flags;  // not what the sample came with
  if (verdict.usable) {
    if ((verdict.flags & flag::kGap) != 0 && verdict.dt_s > usual_s) {
      ++gaps_;
      missing_s_ += verdict.dt_s - usual_s;
    }
    last_utime_ = sample.utime;
    late_in_a_row_ = 0;
  } else if (last_utime_ && sample.utime <= *last_utime_) {
    add_late(sample);
  } else if ((found & flag::kSpike) != 0) {
    ++spikes_;
  } else if ((found & flag::kFlatLine) != 0) {
    ++flat_;
  } else if ((found & flag::kGap) != 0) {
    ++ahead_;
  } else {
    ++implausible_;
  }
}

void SampleWatch::add_late(const estimator::ImuSample& sample) {
  ++late_;
  if (late_in_a_row_ == 0 || sample.utime <= late_utime_) {
    late_in_a_row_ = 0;
    row_ = {samples_, sample.utime,
            static_cast<double>(*last_utime_ - sample.utime) * kMicrosecond + guard_.usual_interval_s()};
  }
  late_utime_ = sample.utime;
  if (++late_in_a_row_ == kSetBack && set_back_.sample == 0) set_back_ = row_;
}

std::string SampleWatch::words() const {
  std::string reasons;
  const auto tell = [&reasons](std::int64_t count, const std::string& what) {
    if (count > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, what);
  };
  std::string clock;
  if (set_back_.sample > 0)
    clock = fmt::format(" (from sample {}, time {}: was the clock set back by {:.1f} s?)", set_back_.sample,
                        set_back_.utime, set_back_.by_s);
  tell(late_, "of a time not after that of the sample before" + clock);
  tell(ahead_, "of a time a minute or more ahead of all before");
  tell(implausible_, "not finite or beyond what is plausible");
  tell(spikes_, spikes_ == 1 ? "spike" : "spikes");
  tell(flat_, "of a reading that stands still");
  std::string said;
  if (!reasons.empty()) said = fmt::format("{} of {} samples left out: {}", left_out(), samples_, reasons);
  if (gaps_ > 0)
    said += fmt::format("{}{} {} in the times, {:.2f} s in all", said.empty() ? "" : "; ", gaps_,
                        gaps_ == 1 ? "gap" : "gaps", missing_s_);
  return said;
}

}  // namespace waverig::rig
