// Painter that only remembers which cells of a coarse grid were touched.
#pragma once
#include <vector>

#include "render/font_book.h"
#include "render/painter.h"

namespace waverig::render {

class Occupancy : public Painter {
 public:
  Occupancy(const Rect& area, float cell_px, const FontBook& fonts);
  void stroke(std::span<const Vec2> points, Color color, float width_px) override;
  void fill_convex(std::span<const Vec2> corners, Color color) override;
  void fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) override;
  void fill_rect(const Rect& rect, Color color) override;
  void text(Vec2 at, std::string_view utf8, const TextStyle& style) override;
  void push_clip(const Rect&) override {}
  void pop_clip() override {}

  // Share of the rectangle's cells that are taken; what lies outside the area
  // counts as taken.
  double taken(const Rect& rect) const;

 private:
  void mark(Vec2 p);
  Rect area_;
  float cell_px_;
  const FontBook& fonts_;
  int columns_, rows_;
  std::vector<unsigned char> cells_;
};

}  // namespace waverig::render
