// GlContext: one off-screen OpenGL 3.3 core context in software (OSMesa,
// llvmpipe).
//
// The only place that knows how a context is made: a later Mesa without OSMesa
// changes this one file (EGL surfaceless gave the same pixels). A context
// belongs to the thread that made it; never fork after one.
#pragma once
#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <memory>

namespace waverig::render {

class GlContext {
 public:
  GlContext();  // and makes it current; throws std::runtime_error where Mesa
                // refuses
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  void make_current();

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

// Compiles and links; throws std::runtime_error with the driver's log.
GLuint make_program(const char* vertex_source, const char* fragment_source);

// A colour (RGBA8) and depth target of its own, multisampled on demand.
class RenderTarget {
 public:
  RenderTarget(int width_px, int height_px, bool with_depth);
  ~RenderTarget();
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;
  void bind() const;
  GLuint framebuffer() const { return framebuffer_; }
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

 private:
  int width_px_, height_px_;
  GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace waverig::render
