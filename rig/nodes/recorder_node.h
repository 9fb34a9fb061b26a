// RecorderNode: writes everything on the bus into an LCM event log, each event at its message's own utime.
// A recorder of our own, since lcm-logger loses events in a burst and at its end.
#pragma once
#include <cstdint>
#include <filesystem>

#include "lcmtypes/bus.h"
#include "lcmtypes/event_log.h"

namespace waverig::rig {

class RecorderNode {
 public:
  // Writes to PATH.part and renames it to PATH in close(): a log under its own name is whole.
  RecorderNode(Bus& bus, const std::filesystem::path& path);
  void close();
  std::int64_t events() const { return writer_.events(); }

 private:
  std::filesystem::path path_, part_;
  EventLogWriter writer_;
};

}  // namespace waverig::rig
