// What every message of waverig begins with, read from its bytes: fingerprint, int64_t utime, int64_t seq,
// big-endian.
#pragma once
#include <cstddef>
#include <cstdint>

namespace waverig::rig {

struct MessageHead {
  std::int64_t utime = 0, seq = 0;  // 0 where the message is too short to hold them
};

inline MessageHead head_of(const void* data, std::size_t size) {
  const auto number_at = [&](std::size_t place) {
    if (size < place + 8) return std::int64_t{0};
    const auto* byte = static_cast<const unsigned char*>(data) + place;
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value = value << 8 | byte[i];
    return static_cast<std::int64_t>(value);
  };
  return {number_at(8), number_at(16)};
}

}  // namespace waverig::rig
