// Painter into an ImDrawList: everything becomes triangles of one vertex
// buffer, with antialiased edges.
#pragma once
#include <imgui.h>
#include <imgui_internal.h>

#include "render/font_book.h"
#include "render/painter.h"

namespace waverig::render {

class DrawListPainter : public Painter {
 public:
  // fonts must be baked and stay as they are until the list is drawn.
  DrawListPainter(FontBook& fonts, int width_px, int height_px);
  void stroke(std::span<const Vec2> points, Color color, float width_px) override;
  void fill_convex(std::span<const Vec2> corners, Color color) override;
  void fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) override;
  void fill_rect(const Rect& rect, Color color) override;
  void text(Vec2 at, std::string_view utf8, const TextStyle& style) override;
  void push_clip(const Rect& rect) override;
  void pop_clip() override;
  const ImDrawList& list() const { return list_; }

 private:
  FontBook& fonts_;
  ImDrawListSharedData shared_;
  ImDrawList list_;
};

}  // namespace waverig::render
