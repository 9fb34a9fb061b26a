#include "rig/cli/nodes/listen.h"

#include <chrono>

namespace waverig::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kTick_ms = 50;
constexpr std::chrono::seconds kLongestWait{60}, kMotionSilence{5};

// How long a count has stood still.
class Stillness {
 public:
  Clock::duration since(std::int64_t count) {
    const auto now = Clock::now();
    if (count != count_) {
      count_ = count;
      since_ = now;
    }
    return now - since_;
  }

 private:
  std::int64_t count_ = -1;
  Clock::time_point since_;
};

}  // namespace

Ending listen_to_record(Bus& bus, Requests& requests, const rig::RunWatch& watch, double quiet_s) {
  Stillness estimates, motion, end;
  while (requests.next() != Request::kStop) {
    bus.handle(kTick_ms);
    const auto silent = motion.since(watch.axis_messages());
    if (watch.begun() && !watch.ended() && silent > kMotionSilence) return Ending::kMotionSilent;
    const auto ended = end.since(watch.ended() ? 1 : 0);
    const auto quiet = estimates.since(watch.ended() ? watch.estimates() : -1);
    if (watch.ended() && (quiet > std::chrono::duration<double>(quiet_s) || ended > kLongestWait))
      return Ending::kRecordOver;
  }
  return Ending::kToldToStop;
}

}  // namespace waverig::cli
