// Pictures in tests: read back with libpng (waverig writes its PNG without it), compared, searched.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "render/color.h"
#include "render/image.h"

namespace waverig::test {

struct DecodedPng {
  render::Image image;
  std::map<std::string, std::string> text;
  double dots_per_inch = 0;
};
DecodedPng decode_png(
    const std::vector<std::uint8_t>& bytes);  // throws std::runtime_error where libpng refuses
std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path);

render::Color pixel(const render::Image& image, int x, int y);
// Pixels within `tolerance` (0 to 1, each channel) of a colour.
std::size_t count_near(const render::Image& image, render::Color color, float tolerance);

// A folder of its own under the system's temporary one, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace waverig::test
