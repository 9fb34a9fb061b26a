#include "rig/frontend/crc.h"

#include <fmt/format.h>

#include <string_view>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

std::uint32_t reflected(std::uint32_t value, int bits) {
  std::uint32_t result = 0;
  for (int i = 0; i < bits; ++i) result |= ((value >> i) & 1U) << (bits - 1 - i);
  return result;
}

}  // namespace

Crc::Crc(const CrcParameters& p) : parameters_(p) {
  if (p.width < 8 || p.width > 32)
    throw UserError(fmt::format("crc.width = {}: expected 8 to 32 bits", p.width));
  mask_ = p.width == 32 ? 0xFFFFFFFFU : (1U << p.width) - 1;
  const int align = 32 - p.width;
  const std::uint32_t poly = p.refin ? reflected(p.poly & mask_, p.width) : (p.poly & mask_) << align;
  start_ = p.refin ? reflected(p.init & mask_, p.width) : (p.init & mask_) << align;
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t r = p.refin ? byte : byte << 24;
    for (int bit = 0; bit < 8; ++bit)
      r = p.refin ? (r >> 1) ^ ((r & 1U) != 0 ? poly : 0) : (r << 1) ^ ((r & 0x80000000U) != 0 ? poly : 0);
    table_[byte] = r;
  }
  constexpr std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  if (const std::uint32_t found = of(digits); found != (p.check & mask_))
    throw UserError(fmt::format("crc.check = 0x{:X}: expected 0x{:X}, the check value of these parameters",
                                p.check, found));
}

std::uint32_t Crc::of(std::span<const std::uint8_t> bytes) const {
  std::uint32_t r = start_;
  if (parameters_.refin) {
    for (const std::uint8_t byte : bytes) r = (r >> 8) ^ table_[(r ^ byte) & 0xFF];
  } else {
    for (const std::uint8_t byte : bytes) r = (r << 8) ^ table_[(r >> 24) ^ byte];
    r >>= 32 - parameters_.width;
  }
  if (parameters_.refin != parameters_.refout) r = reflected(r, parameters_.width);
  return (r ^ parameters_.xorout) & mask_;
}

}  // namespace waverig::rig
