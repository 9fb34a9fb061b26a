// Kept frames of a recording as bytes in the store: columns of 32-bit increments, compressed (zlib format).
#pragma once
#include <cstdint>
#include <vector>

namespace waverig::rig::bench {

// columns of equal length.
std::vector<std::uint8_t> pack_columns(const std::vector<std::vector<std::int32_t>>& columns);
// Throws UserError where the bytes are not what pack_columns made.
std::vector<std::vector<std::int32_t>> unpack_columns(const std::vector<std::uint8_t>& bytes);

}  // namespace waverig::rig::bench
