#include "rig/nodes/recorder_node.h"

#include <algorithm>
#include <string>

namespace waverig::rig {
namespace {

// Every message of waverig begins with its fingerprint and then int64_t utime, big-endian.
constexpr std::size_t kUtimeAt = 8;

std::int64_t utime_of(const void* data, std::size_t size) {
  if (size < kUtimeAt + 8) return 0;
  const auto* byte = static_cast<const unsigned char*>(data) + kUtimeAt;
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | byte[i];
  return static_cast<std::int64_t>(value);
}

std::filesystem::path with_suffix(std::filesystem::path path, const char* suffix) { return path += suffix; }

}  // namespace

RecorderNode::RecorderNode(Bus& bus, const std::filesystem::path& path)
    : path_(path), part_(with_suffix(path, ".part")), writer_(part_) {
  bus.subscribe_raw(".*", [this](std::string_view channel, const void* data, std::size_t size) {
    latest_utime_ = std::max(latest_utime_, utime_of(data, size));
    writer_.write(latest_utime_, channel, data, size);
  });
}

void RecorderNode::close() {
  writer_.close();
  std::filesystem::rename(part_, path_);
}

}  // namespace waverig::rig
