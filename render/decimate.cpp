#include "render/decimate.h"

#include <algorithm>
#include <cmath>

namespace waverig::render {

std::vector<Vec2> decimated(std::vector<Vec2> points) {
  if (points.size() < 8) return points;
  if (!std::is_sorted(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; })) return points;
  std::vector<Vec2> kept;
  for (std::size_t begin = 0; begin < points.size();) {
    const float column = std::floor(points[begin].x);
    std::size_t end = begin + 1, lowest = begin, highest = begin;
    for (; end < points.size() && points[end].x < column + 1; ++end) {
      if (points[end].y < points[lowest].y) lowest = end;
      if (points[end].y > points[highest].y) highest = end;
    }
    if (end - begin <= 3) {
      kept.insert(kept.end(), points.begin() + static_cast<std::ptrdiff_t>(begin),
                  points.begin() + static_cast<std::ptrdiff_t>(end));
    } else {
      kept.push_back(points[std::min(lowest, highest)]);
      if (lowest != highest) kept.push_back(points[std::max(lowest, highest)]);
    }
    begin = end;
  }
  return kept;
}

}  // namespace waverig::render
