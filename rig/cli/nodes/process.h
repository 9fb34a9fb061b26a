// What a node's process needs of the operating system: requests by signal, the rig's time, a place in the
// queue.
#pragma once
#include <signal.h>

#include <cstdint>

namespace waverig::cli {

enum class Request { kNone, kStop, kHold, kResume };

// Takes SIGINT, SIGTERM and SIGHUP (stop), SIGUSR1 (hold) and SIGUSR2 (resume) as requests that are asked
// for, so that no call is interrupted and every way out is an ordinary one. To be made before any thread is;
// for the rest of the process.
class Requests {
 public:
  Requests();
  Request next();  // without waiting

 private:
  sigset_t taken_;
};

// The rig's time, microseconds: the machine's, from which it departs only where a simulated rig runs at
// another speed than 1. Processes with the same epoch and speed agree. Never runs back.
class RigClock {
 public:
  RigClock(std::int64_t epoch_utime, double speed);
  std::int64_t now() const;
  void sleep_until(std::int64_t utime) const;

 private:
  std::int64_t begin_utime_ = 0, begin_steady_ns_ = 0;
  double speed_;
};

// Asks for real-time scheduling; false where this user may not have it.
bool become_real_time();

}  // namespace waverig::cli
