#include "render/gl_context.h"

#include <GL/osmesa.h>

#include <stdexcept>
#include <string>

namespace waverig::render {

// OSMesa wants a buffer of its own; everything here is drawn into framebuffer
// objects, so it stays small.
struct GlContext::Handle {
  OSMesaContext context = nullptr;
  std::array<unsigned char, 4 * 4 * 4> pixels{};
  ~Handle() {
    if (context != nullptr) OSMesaDestroyContext(context);
  }
};

GlContext::GlContext() : handle_(std::make_unique<Handle>()) {
  const std::array<int, 15> attributes = {OSMESA_FORMAT,
                                          OSMESA_RGBA,
                                          OSMESA_DEPTH_BITS,
                                          0,
                                          OSMESA_STENCIL_BITS,
                                          0,
                                          OSMESA_ACCUM_BITS,
                                          0,
                                          OSMESA_PROFILE,
                                          OSMESA_CORE_PROFILE,
                                          OSMESA_CONTEXT_MAJOR_VERSION,
                                          3,
                                          OSMESA_CONTEXT_MINOR_VERSION,
                                          3,
                                          0};
  handle_->context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (handle_->context == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
  make_current();
}

GlContext::~GlContext() = default;

void GlContext::make_current() {
  if (OSMesaMakeCurrent(handle_->context, handle_->pixels.data(), GL_UNSIGNED_BYTE, 4, 4) == GL_FALSE)
    throw std::runtime_error("OSMesa cannot make its context current");
}

namespace {

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_FALSE) {
    std::string log(2048, '\0');
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error("shader does not compile: " + log);
  }
  return shader;
}

}  // namespace

GLuint make_program(const char* vertex_source, const char* fragment_source) {
  const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_FALSE) throw std::runtime_error("shader program does not link");
  return program;
}

RenderTarget::RenderTarget(int width_px, int height_px, bool with_depth)
    : width_px_(width_px), height_px_(height_px) {
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glGenRenderbuffers(1, &colour_);
  glBindRenderbuffer(GL_RENDERBUFFER, colour_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  if (with_depth) {
    glGenRenderbuffers(1, &depth_);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_px, height_px);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  }
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("a picture of " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                             " pixels is too large for the renderer (16384 at most)");
}

RenderTarget::~RenderTarget() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(1, &colour_);
  if (depth_ != 0) glDeleteRenderbuffers(1, &depth_);
}

void RenderTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_px_, height_px_);
}

}  // namespace waverig::render
