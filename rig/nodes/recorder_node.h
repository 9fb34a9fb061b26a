// RecorderNode: writes everything on the bus into an LCM event log. An event's time is the latest utime of
// any message so far: what speaks of the past (a wave, of its start) stands where it was said, and time never
// runs back. A recorder of our own, since lcm-logger loses events in a burst and at its end.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "lcmtypes/bus.h"
#include "lcmtypes/event_log.h"
#include "rig/nodes/sequence_watch.h"

namespace waverig::rig {

class RecorderNode {
 public:
  // Writes to PATH.part and renames it to PATH in close(): a log under its own name is whole.
  RecorderNode(Bus& bus, const std::filesystem::path& path);
  void close();
  std::int64_t events() const { return writer_.events(); }
  // Channels on which messages were lost, by their seq, and how many.
  std::map<std::string, std::int64_t> missing() const;

 private:
  std::filesystem::path path_, part_;
  std::int64_t latest_utime_ = 0;
  EventLogWriter writer_;
  std::map<std::string, SequenceWatch, std::less<>> counted_;  // those of waverig that count every message
};

}  // namespace waverig::rig
