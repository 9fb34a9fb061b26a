#include "render/png.h"

#include <libdeflate.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "lcmtypes/atomic_file.h"

namespace waverig::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_u32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

// PNG specification, section 5.3: length, type, data, CRC-32 of type and data.
void put_chunk(Bytes& out, std::string_view type, const std::uint8_t* data, std::size_t size) {
  put_u32(out, static_cast<std::uint32_t>(size));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data, data + size);
  put_u32(out, libdeflate_crc32(0, out.data() + begin, out.size() - begin));
}

// RGB rows with filter "Up" (section 9.2): flat areas and straight edges become
// zeros.
void filter_rows(const Image& image, Bytes& rows) {
  const auto width = static_cast<std::size_t>(image.width_px),
             height = static_cast<std::size_t>(image.height_px);
  rows.resize(height * (1 + 3 * width));
  const std::vector<std::uint8_t> blank(4 * width, 0);  // above the first row
  for (std::size_t y = 0; y < height; ++y) {
    std::uint8_t* out = rows.data() + y * (1 + 3 * width);
    const std::uint8_t* line = image.rgba.data() + 4 * width * y;
    const std::uint8_t* above = y == 0 ? blank.data() : line - 4 * width;
    *out++ = 2;
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < 3; ++c)
        out[3 * x + c] = static_cast<std::uint8_t>(line[4 * x + c] - above[4 * x + c]);
    }
  }
}

constexpr int kLevel = 1;  // higher levels save a few percent of a figure and
                           // cost several times the time

}  // namespace

PngEncoder::PngEncoder() : compressor_(libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor) {}

const std::vector<std::uint8_t>& PngEncoder::encode(const Image& image, const PngSettings& settings) {
  filter_rows(image, rows_);
  compressed_.resize(libdeflate_zlib_compress_bound(compressor_.get(), rows_.size()));
  const std::size_t size = libdeflate_zlib_compress(compressor_.get(), rows_.data(), rows_.size(),
                                                    compressed_.data(), compressed_.size());
  Bytes& out = file_;
  out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

  Bytes header;
  put_u32(header, static_cast<std::uint32_t>(image.width_px));
  put_u32(header, static_cast<std::uint32_t>(image.height_px));
  header.insert(header.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB, deflate, adaptive filters, no interlace
  put_chunk(out, "IHDR", header.data(), header.size());

  Bytes physical;
  const auto dots_per_metre = static_cast<std::uint32_t>(std::lround(settings.dots_per_inch / 0.0254));
  put_u32(physical, dots_per_metre);
  put_u32(physical, dots_per_metre);
  physical.push_back(1);  // the unit is the metre
  put_chunk(out, "pHYs", physical.data(), physical.size());

  for (const auto& [keyword, text] : settings.text) {
    Bytes chunk(keyword.begin(), keyword.end());
    chunk.insert(chunk.end(),
                 {0, 0, 0, 0, 0});  // end of keyword, not compressed, no language, no translation
    chunk.insert(chunk.end(), text.begin(), text.end());
    put_chunk(out, "iTXt", chunk.data(), chunk.size());
  }
  put_chunk(out, "IDAT", compressed_.data(), size);
  put_chunk(out, "IEND", nullptr, 0);
  return out;
}

void write_file(const std::filesystem::path& path, const void* data, std::size_t size) {
  write_atomically(path, {static_cast<const char*>(data), size});
}

}  // namespace waverig::render
