#include "rig/cli/nodes/process.h"

#include <sched.h>
#include <time.h>

#include <cmath>
#include <ctime>
#include <initializer_list>
#include <limits>

#include "rig/cli/signals.h"

namespace waverig::cli {
namespace {

std::int64_t read_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1000000000 + t.tv_nsec;
}

}  // namespace

Requests::Requests() : taken_{} {
  sigemptyset(&taken_);
  for (const int each : {SIGINT, SIGTERM, SIGUSR1, SIGUSR2}) sigaddset(&taken_, each);
  if (!is_ignored(SIGHUP)) sigaddset(&taken_, SIGHUP);
  sigset_t blocked = taken_;
  sigaddset(&blocked, SIGPIPE);  // a reader that is gone shows as an error of the write
  pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
}

Request Requests::next() {
  const timespec at_once{};
  switch (sigtimedwait(&taken_, nullptr, &at_once)) {
    case SIGINT:
    case SIGTERM:
    case SIGHUP:
      return Request::kStop;
    case SIGUSR1:
      return Request::kHold;
    case SIGUSR2:
      return Request::kResume;
    default:
      return Request::kNone;
  }
}

RigClock::RigClock(std::int64_t epoch_utime, double speed) : speed_(speed) {
  // Both clocks at one moment: the best of some tries, since a process may lose the processor between two
  // readings.
  std::int64_t real_ns = 0, best_ns = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < 20; ++i) {
    const std::int64_t before = read_ns(CLOCK_MONOTONIC), real = read_ns(CLOCK_REALTIME),
                       after = read_ns(CLOCK_MONOTONIC);
    if (after - before >= best_ns) continue;
    best_ns = after - before;
    real_ns = real;
    begin_steady_ns_ = before + (after - before) / 2;
  }
  const std::int64_t real_utime = real_ns / 1000;
  begin_utime_ = epoch_utime + std::llround(static_cast<double>(real_utime - epoch_utime) * speed_);
}

std::int64_t RigClock::now() const {
  const std::int64_t passed_ns = read_ns(CLOCK_MONOTONIC) - begin_steady_ns_;
  return begin_utime_ + std::llround(1e-3 * static_cast<double>(passed_ns) * speed_);
}

void RigClock::sleep_until(std::int64_t utime) const {
  const std::int64_t at_ns =
      begin_steady_ns_ + std::llround(1e3 * static_cast<double>(utime - begin_utime_) / speed_);
  const timespec at{.tv_sec = at_ns / 1000000000, .tv_nsec = at_ns % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

bool become_real_time() {
  sched_param parameters{};
  parameters.sched_priority = 20;
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

}  // namespace waverig::cli
