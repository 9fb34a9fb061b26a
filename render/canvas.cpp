#include "render/canvas.h"

#include <cstddef>

#include "render/draw_list_painter.h"

namespace waverig::render {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
uniform vec2 half_size;
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 color;
out vec2 frag_texel;
out vec4 frag_color;
void main() {
  frag_texel = texel;
  frag_color = color;
  gl_Position = vec4(position / half_size - 1.0, 0.0, 1.0);   // row 0 of memory is the top of the picture
})";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D coverage;
in vec2 frag_texel;
in vec4 frag_color;
out vec4 color;
void main() {
  // Lines carry distances instead of a texel (see Ribbon in draw_list_painter.cpp).
  float covered = frag_texel.y < 0.0 ? clamp(-frag_texel.y - abs(frag_texel.x), 0.0, 1.0)
                                     : texture(coverage, frag_texel).r;
  color = vec4(frag_color.rgb, frag_color.a * covered);
})";

}  // namespace

Canvas::Canvas() : program_(make_program(kVertexShader, kFragmentShader)) {
  half_size_ = glGetUniformLocation(program_, "half_size");
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(1, &vertex_buffer_);
  glGenBuffers(1, &index_buffer_);
  glGenTextures(1, &font_texture_);
}

Canvas::~Canvas() {
  context_.make_current();
  target_.reset();
  glDeleteTextures(1, &font_texture_);
  glDeleteBuffers(1, &vertex_buffer_);
  glDeleteBuffers(1, &index_buffer_);
  glDeleteVertexArrays(1, &vertex_array_);
  glDeleteProgram(program_);
}

RenderTarget& Canvas::target(int width_px, int height_px) {
  if (!target_ || target_->width_px() != width_px || target_->height_px() != height_px) {
    target_.reset();
    target_ = std::make_unique<RenderTarget>(width_px, height_px, false);
  }
  return *target_;
}

const Image& Canvas::draw(int width_px, int height_px, Color background,
                          const std::function<void(Painter&)>& paint) {
  context_.make_current();
  const RenderTarget& picture = target(width_px, height_px);
  picture.bind();
  glDisable(GL_SCISSOR_TEST);
  glClearColor(background.r, background.g, background.b, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  draw_over(picture, paint);
  return read(picture);
}

void Canvas::draw_over(const RenderTarget& picture, const std::function<void(Painter&)>& paint) {
  draw_over(picture, {0, 0, static_cast<float>(picture.width_px()), static_cast<float>(picture.height_px())},
            paint);
}

void Canvas::draw_over(const RenderTarget& picture, const Rect& area,
                       const std::function<void(Painter&)>& paint) {
  context_.make_current();
  if (fonts_.bake()) {
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    fonts_.atlas().GetTexDataAsAlpha8(&texels, &width, &height);
    glBindTexture(GL_TEXTURE_2D, font_texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, texels);
    // Texels always fall on pixels; nearest keeps text independent of where the
    // atlas holds it.
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  DrawListPainter painter(fonts_, static_cast<int>(area.width()), static_cast<int>(area.height()));
  paint(painter);
  picture.bind();
  submit(painter.list(), area);
}

void Canvas::submit(const ImDrawList& list, const Rect& area) {
  const auto left = static_cast<GLint>(area.left), top = static_cast<GLint>(area.top);
  glViewport(left, top, static_cast<GLsizei>(area.width()), static_cast<GLsizei>(area.height()));
  glUseProgram(program_);
  glUniform2f(half_size_, 0.5F * area.width(), 0.5F * area.height());
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.VtxBuffer.size_in_bytes()), list.VtxBuffer.Data,
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.IdxBuffer.size_in_bytes()),
               list.IdxBuffer.Data, GL_STREAM_DRAW);
  const auto attribute = [](GLuint index, GLint size, GLenum type, GLboolean normalised, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, normalised, sizeof(ImDrawVert),
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
  glBindTexture(GL_TEXTURE_2D, font_texture_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const ImVec4& clip = command.ClipRect;
    if (command.ElemCount == 0 || clip.z <= clip.x || clip.w <= clip.y) continue;
    glScissor(left + static_cast<GLint>(clip.x), top + static_cast<GLint>(clip.y),
              static_cast<GLsizei>(clip.z - clip.x), static_cast<GLsizei>(clip.w - clip.y));
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), GL_UNSIGNED_SHORT,
                             reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)),
                             static_cast<GLint>(command.VtxOffset));
  }
  glDisable(GL_SCISSOR_TEST);
}

const Image& Canvas::read(const RenderTarget& picture) {
  image_.width_px = picture.width_px();
  image_.height_px = picture.height_px();
  image_.rgba.resize(4 * static_cast<std::size_t>(image_.width_px) *
                     static_cast<std::size_t>(image_.height_px));
  glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image_.width_px, image_.height_px, GL_RGBA, GL_UNSIGNED_BYTE, image_.rgba.data());
  return image_;
}

}  // namespace waverig::render
