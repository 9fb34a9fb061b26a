#include "rig/nodes/run_watch.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <waverig/alarm_t.hpp>
#include <waverig/axis_t.hpp>
#include <waverig/record_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/phase.h"
#include "rig/nodes/message_head.h"

namespace waverig::rig {
namespace {

constexpr std::int32_t kMotionStops = 2;  // severity, alarm_t.lcm

// One line for a terminal, whoever wrote it.
std::string text_of(const alarm_t& m) {
  std::string text;
  for (const std::uint8_t byte : m.text) {
    if (byte == 0) break;
    text += byte < 0x20 || byte == 0x7F ? ' ' : static_cast<char>(byte);
  }
  return text.empty() ? "alarm " + std::to_string(m.code) : text;
}

}  // namespace

RunWatch::RunWatch(Bus& bus) {
  bus.subscribe<record_t>(channel::kRecord, [this](const record_t& m) {
    if (m.action == static_cast<std::int32_t>(RecordAction::kBegin)) begun_ = true;
    if (m.action != static_cast<std::int32_t>(RecordAction::kEnd) || !begun_ || ended_) return;
    ended_ = true;
    end_utime_ = m.utime;
  });
  bus.subscribe<alarm_t>(channel::kAlarm, [this](const alarm_t& m) {
    if (m.severity >= kMotionStops && stopped_.empty()) stopped_ = text_of(m);
  });
  bus.subscribe<axis_t>(channel::kAxis, [this](const axis_t&) { ++axis_messages_; });
  for (const auto prefix : {channel::kHeavePrefix, channel::kWavePrefix, channel::kSeaPrefix})
    bus.subscribe_raw(escaped_channel(prefix) + ".+",
                      [this](std::string_view, const void* data, std::size_t size) {
                        if (begun_ && (!ended_ || head_of(data, size).utime <= end_utime_)) ++estimates_;
                      });
}

}  // namespace waverig::rig
