// Canvas: one thread's renderer. Keeps context, shader and font texture warm
// from figure to figure.
#pragma once
#include <functional>
#include <memory>

#include "render/font_book.h"
#include "render/gl_context.h"
#include "render/image.h"
#include "render/painter.h"
#include "render/png.h"

namespace waverig::render {

class Canvas {
 public:
  Canvas();
  ~Canvas();
  FontBook& fonts() { return fonts_; }
  GlContext& context() { return context_; }

  // Draws onto a picture of that size, filled with the background. Fonts and
  // characters must be required before. The picture stays until the next one is
  // drawn.
  const Image& draw(int width_px, int height_px, Color background,
                    const std::function<void(Painter&)>& paint);
  // The same over what a target already shows (labels over a scene), whole or
  // in a part of it that then is the painter's page; read it back with read().
  void draw_over(const RenderTarget& target, const std::function<void(Painter&)>& paint);
  void draw_over(const RenderTarget& target, const Rect& area, const std::function<void(Painter&)>& paint);
  const Image& read(const RenderTarget& target);
  // Of PNG files, with its buffers kept.
  PngEncoder& png() { return png_; }

 private:
  RenderTarget& target(int width_px, int height_px);
  void submit(const ImDrawList& list, const Rect& area);

  GlContext context_;
  FontBook fonts_;
  GLuint program_ = 0, vertex_array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0, font_texture_ = 0;
  GLint half_size_ = -1;
  std::unique_ptr<RenderTarget> target_;
  Image image_;
  PngEncoder png_;
};

}  // namespace waverig::render
