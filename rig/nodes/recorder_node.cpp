#include "rig/nodes/recorder_node.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "lcmtypes/channels.h"
#include "lcmtypes/disk.h"
#include "rig/nodes/message_head.h"

namespace waverig::rig {
namespace {

// What LCM itself sends whenever a program joins a multicast bus.
constexpr std::string_view kSelfTest = "LCM_SELF_TEST";

std::filesystem::path with_suffix(std::filesystem::path path, const char* suffix) { return path += suffix; }

}  // namespace

RecorderNode::RecorderNode(Bus& bus, const std::filesystem::path& path)
    : path_(led_to(path)), part_(with_suffix(path_, ".part")), writer_(part_) {
  for (const auto counted : {channel::kImu, channel::kTruth, channel::kAxis, channel::kRun, channel::kRecord})
    counted_.try_emplace(std::string(counted));
  bus.subscribe_raw(".*", [this](std::string_view channel, const void* data, std::size_t size) {
    if (channel == kSelfTest) return;
    const MessageHead head = head_of(data, size);
    latest_utime_ = std::max(latest_utime_, head.utime);
    writer_.write(latest_utime_, channel, data, size);
    if (const auto counted = counted_.find(channel); counted != counted_.end())
      counted->second.missing_before(head.seq);
  });
}

std::map<std::string, std::int64_t> RecorderNode::missing() const {
  std::map<std::string, std::int64_t> missing;
  for (const auto& [channel, watch] : counted_)
    if (watch.missing() > 0) missing[channel] = watch.missing();
  return missing;
}

void RecorderNode::close() {
  writer_.close();
  rename_whole(part_, path_);
}

}  // namespace waverig::rig
