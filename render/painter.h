// Painter: the few strokes every figure is made of. Pixels, origin at the top
// left, y down. Two stand behind it: an ImDrawList for the screen of pixels,
// and an SVG file for the page.
#pragma once
#include <span>
#include <string_view>

#include "render/color.h"

namespace waverig::render {

struct Vec2 {
  float x = 0, y = 0;
};

struct Rect {
  float left = 0, top = 0, right = 0, bottom = 0;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
  bool contains(Vec2 p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
};

enum class HAlign { kLeft, kCenter, kRight };
enum class VAlign { kTop, kMiddle, kBaseline };  // of capital letters

struct TextStyle {
  float size_px = 12;  // em
  Color color;
  HAlign h = HAlign::kLeft;
  VAlign v = VAlign::kBaseline;
  bool bold = false;
  bool upwards = false;  // turned by 90 degrees; h runs along the text
};

class Painter {
 public:
  virtual ~Painter() = default;
  // A line through the points; consecutive ones may coincide.
  virtual void stroke(std::span<const Vec2> points, Color color, float width_px) = 0;
  virtual void fill_convex(std::span<const Vec2> corners, Color color) = 0;
  // The area between two lines of equally many points.
  virtual void fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) = 0;
  virtual void fill_rect(const Rect& rect, Color color) = 0;
  virtual void text(Vec2 at, std::string_view utf8, const TextStyle& style) = 0;
  virtual void push_clip(const Rect& rect) = 0;
  virtual void pop_clip() = 0;
};

}  // namespace waverig::render
