#include "rig/bench/frame_data.h"

#include <libdeflate.h>

#include <cstring>
#include <memory>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kHead = 8;  // columns, rows
constexpr std::uint32_t kColumnsMax = 1000, kRowsMax = 100'000'000;
constexpr std::size_t kDeflateMost =
    1040;  // bytes out of one: a header that claims more is believed no memory

}  // namespace

std::vector<std::uint8_t> pack_columns(const std::vector<std::vector<std::int32_t>>& columns) {
  const std::size_t rows = columns.empty() ? 0 : columns.front().size();
  // Byte planes: the high bytes of small increments are alike and pack away.
  std::vector<std::uint8_t> planes;
  planes.reserve(columns.size() * rows * 4);
  for (const auto& column : columns)
    for (int byte = 0; byte < 4; ++byte)
      for (const std::int32_t value : column)
        planes.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * byte)));
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(1), libdeflate_free_compressor);
  std::vector<std::uint8_t> bytes(kHead + libdeflate_zlib_compress_bound(compressor.get(), planes.size()));
  const auto columns32 = static_cast<std::uint32_t>(columns.size()),
             rows32 = static_cast<std::uint32_t>(rows);
  std::memcpy(bytes.data(), &columns32, 4);
  std::memcpy(bytes.data() + 4, &rows32, 4);
  bytes.resize(kHead + libdeflate_zlib_compress(compressor.get(), planes.data(), planes.size(),
                                                bytes.data() + kHead, bytes.size() - kHead));
  return bytes;
}

std::vector<std::vector<std::int32_t>> unpack_columns(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t columns = 0, rows = 0;
  if (bytes.size() >= kHead) {
    std::memcpy(&columns, bytes.data(), 4);
    std::memcpy(&rows, bytes.data() + 4, 4);
  }
  const bool sane = bytes.size() >= kHead && columns <= kColumnsMax && rows <= kRowsMax &&
                    std::size_t{4} * columns * rows <= kDeflateMost * bytes.size();
  std::vector<std::uint8_t> planes(sane ? std::size_t{4} * columns * rows : 0);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  std::size_t size = 0;
  if (!sane ||
      libdeflate_zlib_decompress(decompressor.get(), bytes.data() + kHead, bytes.size() - kHead,
                                 planes.data(), planes.size(), &size) != LIBDEFLATE_SUCCESS ||
      size != planes.size())
    throw UserError("bench store: the kept frames of a recording are broken");
  std::vector<std::vector<std::int32_t>> result(columns, std::vector<std::int32_t>(rows));
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t r = 0; r < rows; ++r) {
      std::uint32_t value = 0;
      for (std::size_t byte = 4; byte-- > 0;) value = (value << 8) | planes[(c * 4 + byte) * rows + r];
      result[c][r] = static_cast<std::int32_t>(value);
    }
  return result;
}

}  // namespace waverig::rig::bench
