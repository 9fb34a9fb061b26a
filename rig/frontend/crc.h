// Cyclic redundancy check of any width up to 32 bits, after the Rocksoft model (width, poly, init, refin,
// refout, xorout), table-driven: the parameters come from a layout file, so boost/crc.hpp's compile-time ones
// do not serve.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace waverig::rig {

struct CrcParameters {
  int width = 16;  // 8 to 32
  std::uint32_t poly = 0x1021, init = 0xFFFF;
  bool refin = false, refout = false;
  std::uint32_t xorout = 0;
  std::uint32_t check = 0x29B1;  // of the bytes "123456789"
};

class Crc {
 public:
  // Throws UserError where the width is not 8 to 32, or the self-test against the check value fails.
  explicit Crc(const CrcParameters& parameters);
  std::uint32_t of(std::span<const std::uint8_t> bytes) const;

 private:
  CrcParameters parameters_;
  std::uint32_t mask_, start_;              // start_: init as the table's register holds it
  std::array<std::uint32_t, 256> table_{};  // register reflected for refin, else left-aligned in 32 bits
};

}  // namespace waverig::rig
