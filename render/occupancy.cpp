#include "render/occupancy.h"

#include <algorithm>
#include <cmath>

namespace waverig::render {

Occupancy::Occupancy(const Rect& area, float cell_px, const FontBook& fonts)
    : area_(area),
      cell_px_(cell_px),
      fonts_(fonts),
      columns_(std::max(1, static_cast<int>(std::ceil(area.width() / cell_px)))),
      rows_(std::max(1, static_cast<int>(std::ceil(area.height() / cell_px)))),
      cells_(static_cast<std::size_t>(columns_ * rows_), 0) {}

void Occupancy::mark(Vec2 p) {
  if (!area_.contains(p)) return;
  const int column = std::min(columns_ - 1, static_cast<int>((p.x - area_.left) / cell_px_));
  const int row = std::min(rows_ - 1, static_cast<int>((p.y - area_.top) / cell_px_));
  cells_[static_cast<std::size_t>(row * columns_ + column)] = 1;
}

void Occupancy::stroke(std::span<const Vec2> points, Color, float) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec2 a = points[i], b = points[i + 1];
    // Far outside the area nothing is marked: the walk is cut to where it may
    // be.
    if ((a.x < area_.left && b.x < area_.left) || (a.x > area_.right && b.x > area_.right) ||
        (a.y < area_.top && b.y < area_.top) || (a.y > area_.bottom && b.y > area_.bottom))
      continue;
    const int steps = 1 + static_cast<int>(2 * std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)) / cell_px_);
    for (int k = 0; k <= steps; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(steps);
      mark({a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share});
    }
  }
}

void Occupancy::fill_convex(std::span<const Vec2> corners, Color color) {
  if (corners.empty()) return;
  Rect box{corners[0].x, corners[0].y, corners[0].x, corners[0].y};
  for (const Vec2 c : corners)
    box = {std::min(box.left, c.x), std::min(box.top, c.y), std::max(box.right, c.x),
           std::max(box.bottom, c.y)};
  fill_rect(box, color);
}

void Occupancy::fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) {
  for (std::size_t i = 0; i + 1 < upper.size(); ++i) {
    const int steps =
        std::clamp(1 + static_cast<int>(std::abs(upper[i + 1].x - upper[i].x) / cell_px_), 1, columns_ + 1);
    for (int k = 0; k <= steps; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(steps);
      const float x = upper[i].x + (upper[i + 1].x - upper[i].x) * share;
      const float a = upper[i].y + (upper[i + 1].y - upper[i].y) * share,
                  b = lower[i].y + (lower[i + 1].y - lower[i].y) * share;
      fill_rect({x, std::min(a, b), x, std::max(a, b)}, color);
    }
  }
}

void Occupancy::fill_rect(const Rect& rect, Color) {
  const Rect r{std::max(rect.left, area_.left), std::max(rect.top, area_.top),
               std::min(rect.right, area_.right), std::min(rect.bottom, area_.bottom)};
  if (r.left > r.right || r.top > r.bottom) return;
  for (float y = r.top;; y = std::min(y + cell_px_, r.bottom)) {
    for (float x = r.left;; x = std::min(x + cell_px_, r.right)) {
      mark({x, y});
      if (x >= r.right) break;
    }
    if (y >= r.bottom) break;
  }
}

void Occupancy::text(Vec2 at, std::string_view utf8, const TextStyle& style) {
  const float width = fonts_.width_px(utf8, style.size_px, style.bold), cap = kCapHeight * style.size_px;
  const float along = style.h == HAlign::kLeft ? 0 : style.h == HAlign::kCenter ? -0.5F * width : -width;
  const float down = style.v == VAlign::kBaseline ? -cap : style.v == VAlign::kMiddle ? -0.5F * cap : 0;
  if (style.upwards)
    fill_rect({at.x + down, at.y - along - width, at.x + down + cap, at.y - along}, style.color);
  else
    fill_rect({at.x + along, at.y + down, at.x + along + width, at.y + down + cap}, style.color);
}

double Occupancy::taken(const Rect& rect) const {
  if (rect.left < area_.left || rect.top < area_.top || rect.right > area_.right ||
      rect.bottom > area_.bottom)
    return 1;
  const auto index = [&](float px, float origin, int most) {
    return std::clamp(static_cast<int>((px - origin) / cell_px_), 0, most - 1);
  };
  const int left = index(rect.left, area_.left, columns_), right = index(rect.right, area_.left, columns_);
  const int top = index(rect.top, area_.top, rows_), bottom = index(rect.bottom, area_.top, rows_);
  int count = 0;
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column)
      count += cells_[static_cast<std::size_t>(row * columns_ + column)];
  }
  return static_cast<double>(count) / ((right - left + 1) * (bottom - top + 1));
}

}  // namespace waverig::render
