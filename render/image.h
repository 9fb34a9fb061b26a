// Image: pixels in memory, RGBA, 8 bits each, rows from the top.
#pragma once
#include <cstdint>
#include <vector>

namespace waverig::render {

struct Image {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height
};

}  // namespace waverig::render
