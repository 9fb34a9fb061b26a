// Painter into an SVG document.
#pragma once
#include <string>

#include "render/font_book.h"
#include "render/painter.h"

namespace waverig::render {

class SvgPainter : public Painter {
 public:
  // User units are the pixels of the figure; the page is width_mm wide.
  SvgPainter(int width_px, int height_px, double width_mm, Color background, const std::string& description);
  void stroke(std::span<const Vec2> points, Color color, float width_px) override;
  void fill_convex(std::span<const Vec2> corners, Color color) override;
  void fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) override;
  void fill_rect(const Rect& rect, Color color) override;
  void text(Vec2 at, std::string_view utf8, const TextStyle& style) override;
  void push_clip(const Rect& rect) override;
  void pop_clip() override;
  std::string finish() &&;  // the document

 private:
  std::string out_;
  int clips_ = 0;
};

// &, <, > and quotes made harmless; control characters dropped.
std::string xml_escaped(std::string_view text);

}  // namespace waverig::render
