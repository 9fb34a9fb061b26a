// VirtualTime: the time of a bench and of the laboratory simulated beside it in the same program, over real
// transports.
//
// The bench alone moves it on, and only while the laboratory is quiet: it has done all there was to do by
// now, and no byte is under way between the two. So every answer arrives at a definite virtual time, silence
// is known to be silence at once, and a run gives the same result however fast or loaded the machine is.
#pragma once
#include <atomic>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <string_view>

namespace waverig::rig::bench {

class VirtualTime {
 public:
  explicit VirtualTime(std::int64_t start_utime);
  ~VirtualTime();
  VirtualTime(const VirtualTime&) = delete;
  VirtualTime& operator=(const VirtualTime&) = delete;

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  std::int64_t now() const { return now_.load(); }

  // Bytes that one side has sent and the other not yet received, by cable: a TCP connection is told by its
  // client's port, a serial line by serial_cable(path). What is on a cable when either side lets go of it is
  // lost.
  void sent(std::int64_t cable, std::int64_t bytes);
  void received(std::int64_t cable, std::int64_t bytes);
  void closed(std::int64_t cable);
  static std::int64_t serial_cable(std::string_view path);  // "/dev/pts/7"

  // The bench's side.
  bool quiet() const { return !busy_.load() && under_way_.load() == 0; }
  void advance_to(std::int64_t utime);  // only while quiet; the laboratory then catches up
  std::int64_t next_event() const { return next_event_.load(); }  // when the laboratory will speak unasked
  int idle_descriptor() const { return idle_descriptor_; }        // readable when the laboratory became idle
  void clear_idle();

  // The laboratory's side.
  int wake_descriptor() const { return wake_descriptor_; }  // readable when time went on
  void clear_wake();
  void busy() { busy_ = true; }
  void idle(std::int64_t next_event_utime);
  // For a transport whose client blocks until it is answered, so that nobody else can move time meanwhile.
  void advance_while_client_blocks(std::int64_t utime) { now_ = utime; }

 private:
  std::atomic<std::int64_t> now_, under_way_{0}, next_event_{kNever};
  std::mutex mutex_;
  std::map<std::int64_t, std::int64_t> on_cable_;
  std::atomic<bool> busy_{false};
  int wake_descriptor_, idle_descriptor_;
};

}  // namespace waverig::rig::bench
