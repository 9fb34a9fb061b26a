#include "rig/bench/virtual_time.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace waverig::rig::bench {
namespace {

int make_event() {
  const int descriptor = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (descriptor < 0) throw std::runtime_error("eventfd: the system has no descriptor left");
  return descriptor;
}

void ring(int descriptor) {
  const std::uint64_t one = 1;
  while (::write(descriptor, &one, sizeof one) < 0 && errno == EINTR) {
  }
}

void clear(int descriptor) {
  std::uint64_t count = 0;
  while (::read(descriptor, &count, sizeof count) < 0 && errno == EINTR) {
  }
}

}  // namespace

VirtualTime::VirtualTime(std::int64_t start_utime)
    : now_(start_utime), wake_descriptor_(make_event()), idle_descriptor_(make_event()) {}

VirtualTime::~VirtualTime() {
  ::close(wake_descriptor_);
  ::close(idle_descriptor_);
}

void VirtualTime::sent(std::int64_t cable, std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  on_cable_[cable] += bytes;
  under_way_ += bytes;
}

void VirtualTime::received(std::int64_t cable, std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  std::int64_t& left = on_cable_[cable];
  const std::int64_t taken = std::min(left, bytes);  // those of a closed cable were counted off before
  left -= taken;
  under_way_ -= taken;
}

void VirtualTime::closed(std::int64_t cable) {
  const std::lock_guard lock(mutex_);
  under_way_ -= std::exchange(on_cable_[cable], 0);
}

std::int64_t VirtualTime::serial_cable(std::string_view path) {
  std::int64_t number = 0;
  const std::string_view digits = path.substr(path.find_last_not_of("0123456789") + 1);
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return 0x10000 + number;  // above every TCP port
}

void VirtualTime::advance_to(std::int64_t utime) {
  busy_ = true;  // before the laboratory knows: nobody may think it quiet in between
  now_ = utime;
  ring(wake_descriptor_);
}

void VirtualTime::clear_idle() { clear(idle_descriptor_); }
void VirtualTime::clear_wake() { clear(wake_descriptor_); }

void VirtualTime::idle(std::int64_t next_event_utime) {
  next_event_ = next_event_utime;
  busy_ = false;
  ring(idle_descriptor_);
}

}  // namespace waverig::rig::bench
