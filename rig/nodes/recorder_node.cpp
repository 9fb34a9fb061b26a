#include "rig/nodes/recorder_node.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "lcmtypes/channels.h"

namespace waverig::rig {
namespace {

// Every message of waverig begins with its fingerprint and then int64_t utime and int64_t seq, big-endian.
constexpr std::size_t kUtimeAt = 8, kSeqAt = 16;

// What LCM itself sends whenever a program joins a multicast bus.
constexpr std::string_view kSelfTest = "LCM_SELF_TEST";

// The int64_t there; 0 where the message is too short.
std::int64_t number_at(std::size_t place, const void* data, std::size_t size) {
  if (size < place + 8) return 0;
  const auto* byte = static_cast<const unsigned char*>(data) + place;
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | byte[i];
  return static_cast<std::int64_t>(value);
}

std::filesystem::path with_suffix(std::filesystem::path path, const char* suffix) { return path += suffix; }

}  // namespace

RecorderNode::RecorderNode(Bus& bus, const std::filesystem::path& path)
    : path_(path), part_(with_suffix(path, ".part")), writer_(part_) {
  for (const auto counted : {channel::kImu, channel::kTruth, channel::kAxis, channel::kRun, channel::kRecord})
    counted_.try_emplace(std::string(counted));
  bus.subscribe_raw(".*", [this](std::string_view channel, const void* data, std::size_t size) {
    if (channel == kSelfTest) return;
    latest_utime_ = std::max(latest_utime_, number_at(kUtimeAt, data, size));
    writer_.write(latest_utime_, channel, data, size);
    if (const auto counted = counted_.find(channel); counted != counted_.end())
      counted->second.missing_before(number_at(kSeqAt, data, size));
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
  std::filesystem::rename(part_, path_);
}

}  // namespace waverig::rig
