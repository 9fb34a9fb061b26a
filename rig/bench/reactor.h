// Reactor: the bench's one place where it waits, in real or virtual time. While it waits for anything it
// serves the ports that never pause, so that no frame is lost behind an instrument that takes its time.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>

#include "rig/bench/virtual_time.h"

namespace waverig::rig::bench {

// The user asked the bench to stop (a signal).
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("stopped by the user") {}
};

class Reactor {
 public:
  // time: nullptr for real time. stop: set by a signal handler; every wait then throws Interrupted.
  explicit Reactor(VirtualTime* time, const std::atomic<bool>* stop = nullptr);
  // Whether waits end by it: a tear-down goes through to its end whatever the user does.
  void heed_stop(bool heed) { heeds_stop_ = heed; }

  std::int64_t now() const;  // microseconds since 1970, UTC; it never jumps back
  VirtualTime* virtual_time() const { return time_; }

  // on_readable is called whenever the descriptor has something, during any wait.
  void serve(int descriptor, std::function<void()> on_readable);
  void forget(int descriptor);

  // True as soon as the descriptor is readable (or at its end), false at the deadline.
  bool wait_readable(int descriptor, std::int64_t deadline_utime);
  void sleep_until(std::int64_t utime);
  // Calls on_turn whenever something was served or time went on by a slice; ends when it returns true, or
  // false at the deadline.
  static constexpr std::int64_t kSlice_us = 10'000'000;
  bool run_until(std::int64_t deadline_utime, const std::function<bool()>& on_turn,
                 std::int64_t slice_us = kSlice_us);

 private:
  // Virtual time: serves until the laboratory is quiet; true as soon as the descriptor (-1: none) is
  // readable.
  bool settle(int descriptor);
  void advance(std::int64_t limit_utime, std::int64_t slice_us);
  // Real time: one round of waiting.
  bool wait_real(int descriptor, std::int64_t limit_utime);
  bool poll_once(int descriptor, int timeout_ms);

  VirtualTime* time_;
  const std::atomic<bool>* stop_;
  bool heeds_stop_ = true;
  std::int64_t real_offset_us_ = 0;
  std::map<int, std::function<void()>> served_;
};

}  // namespace waverig::rig::bench
