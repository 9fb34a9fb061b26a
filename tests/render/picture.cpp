#include "tests/render/picture.h"

#include <png.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace waverig::test {
namespace {

struct Source {
  const std::vector<std::uint8_t>* bytes;
  std::size_t at = 0;
};

void read_from(png_structp png, png_bytep out, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (source->at + size > source->bytes->size()) png_error(png, "truncated");
  std::memcpy(out, source->bytes->data() + source->at, size);
  source->at += size;
}

[[noreturn]] void refuse(png_structp, png_const_charp message) { throw std::runtime_error(message); }

}  // namespace

DecodedPng decode_png(const std::vector<std::uint8_t>& bytes) {
  DecodedPng out;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, refuse,
                             [](png_structp, png_const_charp m) { throw std::runtime_error(m); });
  png_infop info = png_create_info_struct(png);
  Source source{&bytes};
  png_set_read_fn(png, &source, read_from);
  png_read_info(png, info);
  out.image.width_px = static_cast<int>(png_get_image_width(png, info));
  out.image.height_px = static_cast<int>(png_get_image_height(png, info));
  png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  png_read_update_info(png, info);
  const std::size_t row = 4 * static_cast<std::size_t>(out.image.width_px);
  out.image.rgba.resize(row * static_cast<std::size_t>(out.image.height_px));
  for (int y = 0; y < out.image.height_px; ++y)
    png_read_row(png, out.image.rgba.data() + row * static_cast<std::size_t>(y), nullptr);
  png_read_end(png, info);
  png_textp text = nullptr;
  int count = 0;
  png_get_text(png, info, &text, &count);
  for (int i = 0; i < count; ++i) out.text[text[i].key] = text[i].text;
  out.dots_per_inch = static_cast<double>(png_get_x_pixels_per_meter(png, info)) * 0.0254;
  png_destroy_read_struct(&png, &info, nullptr);
  return out;
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

render::Color pixel(const render::Image& image, int x, int y) {
  const std::uint8_t* p =
      image.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) +
                               static_cast<std::size_t>(x));
  return {static_cast<float>(p[0]) / 255, static_cast<float>(p[1]) / 255, static_cast<float>(p[2]) / 255, 1};
}

std::size_t count_near(const render::Image& image, render::Color color, float tolerance) {
  std::size_t n = 0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const render::Color p = pixel(image, x, y);
      if (std::abs(p.r - color.r) <= tolerance && std::abs(p.g - color.g) <= tolerance &&
          std::abs(p.b - color.b) <= tolerance)
        ++n;
    }
  }
  return n;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "waverig-render-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace waverig::test
