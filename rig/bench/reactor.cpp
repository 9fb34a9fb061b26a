#include "rig/bench/reactor.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

namespace waverig::rig::bench {
namespace {

// No byte and no turn for so long in real time: a byte was lost between the two sides, e.g. with a closed
// connection.
constexpr auto kWatchdog = std::chrono::seconds(5);

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Reactor::Reactor(VirtualTime* time, const std::atomic<bool>* stop) : time_(time), stop_(stop) {
  real_offset_us_ = std::chrono::duration_cast<std::chrono::microseconds>(
                        std::chrono::system_clock::now().time_since_epoch())
                        .count() -
                    steady_us();
}

std::int64_t Reactor::now() const { return time_ != nullptr ? time_->now() : steady_us() + real_offset_us_; }

void Reactor::serve(int descriptor, std::function<void()> on_readable) {
  served_[descriptor] = std::move(on_readable);
}
void Reactor::forget(int descriptor) { served_.erase(descriptor); }

bool Reactor::poll_once(int descriptor, int timeout_ms) {
  std::vector<pollfd> waiting;
  waiting.reserve(served_.size() + 2);
  for (const auto& [served, action] : served_) waiting.push_back({served, POLLIN, 0});
  if (descriptor >= 0) waiting.push_back({descriptor, POLLIN, 0});
  if (time_ != nullptr) waiting.push_back({time_->idle_descriptor(), POLLIN, 0});
  if (::poll(waiting.data(), waiting.size(), timeout_ms) < 0 && errno != EINTR)
    throw std::runtime_error(std::string("poll: ") + std::strerror(errno));
  if (heeds_stop_ && stop_ != nullptr && stop_->load()) throw Interrupted();
  if (time_ != nullptr && waiting.back().revents != 0) time_->clear_idle();
  bool readable = false;
  for (const pollfd& w : waiting) {
    if (w.revents == 0) continue;
    if (w.fd == descriptor) readable = true;
    if (const auto action = served_.find(w.fd); action != served_.end()) action->second();
  }
  return readable;
}

bool Reactor::wait_real(int descriptor, std::int64_t limit_utime) {
  const std::int64_t left_ms = (limit_utime - now() + 999) / 1000;
  return poll_once(descriptor, static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, 200)));
}

bool Reactor::settle(int descriptor) {
  const auto started = std::chrono::steady_clock::now();
  while (!time_->quiet()) {
    if (poll_once(descriptor, 100)) return true;
    if (std::chrono::steady_clock::now() - started > kWatchdog)
      throw std::runtime_error("the simulated laboratory does not come to rest");
  }
  return poll_once(descriptor, 0);
}

void Reactor::advance(std::int64_t limit_utime, std::int64_t slice_us) {
  const std::int64_t next = std::min({limit_utime, time_->next_event(), time_->now() + slice_us});
  if (next > time_->now()) time_->advance_to(next);
}

bool Reactor::wait_readable(int descriptor, std::int64_t deadline_utime) {
  while (true) {
    if (time_ != nullptr && settle(descriptor)) return true;
    const bool over = now() >= deadline_utime;
    if (time_ == nullptr && wait_real(descriptor, deadline_utime)) return true;
    if (over) return false;
    if (time_ != nullptr) advance(deadline_utime, kSlice_us);
  }
}

bool Reactor::run_until(std::int64_t deadline_utime, const std::function<bool()>& on_turn,
                        std::int64_t slice_us) {
  while (true) {
    if (time_ != nullptr) settle(-1);
    const bool over = now() >= deadline_utime;
    if (time_ == nullptr) wait_real(-1, deadline_utime);
    if (on_turn()) return true;
    if (over) return false;
    if (time_ != nullptr) advance(deadline_utime, slice_us);
  }
}

void Reactor::sleep_until(std::int64_t utime) {
  run_until(utime, [] { return false; });
}

}  // namespace waverig::rig::bench
