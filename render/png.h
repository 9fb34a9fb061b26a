// PNG files with physical resolution and text chunks.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/image.h"

struct libdeflate_compressor;

namespace waverig::render {

struct PngSettings {
  double dots_per_inch = 200;
  // Keyword and UTF-8 text, e.g. {"Software", "waverig 0.1.0"}; keywords are 1
  // to 79 Latin-1 characters.
  std::vector<std::pair<std::string, std::string>> text;
};

// Writes RGB, since a finished figure is opaque. Keeps its buffers and
// compressor from picture to picture.
class PngEncoder {
 public:
  PngEncoder();
  // The bytes of the file; they stay until the next picture.
  const std::vector<std::uint8_t>& encode(const Image& image, const PngSettings& settings);

 private:
  std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor_;
  std::vector<std::uint8_t> rows_, compressed_, file_;
};

// The file is there whole or not at all: one of before stands until then. Throws UserError where the place
// cannot be written, std::runtime_error where the disk did not take all.
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);

}  // namespace waverig::render
