#include "render/scene/rig_scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "render/stroke.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

constexpr int kSupersampling = 2;

constexpr const char* kVertexShader = R"(#version 330 core
uniform mat4 project;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
out vec3 at;
out vec3 up;
out vec4 paint;
void main() {
  at = position;
  up = normal;
  paint = color;
  gl_Position = project * vec4(position, 1.0);
})";

// A lamp, a sky above and a ground below; glossier where the paint is seen
// through (water).
constexpr const char* kFragmentShader = R"(#version 330 core
uniform vec3 eye;
uniform vec3 lamp;
uniform vec4 haze;   // colour of the distance, and where it begins
in vec3 at;
in vec3 up;
in vec4 paint;
out vec4 color;
void main() {
  vec3 view = normalize(eye - at);
  vec3 n = normalize(up);
  if (dot(n, view) < 0.0) n = -n;
  float sky = 0.5 + 0.5 * n.z;
  float lit = max(dot(n, lamp), 0.0);
  float mirror = max(dot(n, normalize(lamp + view)), 0.0);   // to the 64th power and the 3rd, by multiplication: pow is slow
  mirror *= mirror; mirror *= mirror; mirror *= mirror; mirror *= mirror; mirror *= mirror; mirror *= mirror;
  float rim = 1.0 - max(dot(n, view), 0.0);
  float gloss = (paint.a < 1.0 ? 0.5 : 0.15) * mirror;
  float edge = paint.a < 1.0 ? 0.35 * rim * rim * rim : 0.0;
  vec3 shade = paint.rgb * (mix(0.34, 0.58, sky) + 0.55 * lit) + vec3(gloss + 0.4 * edge);
  float far = clamp((length(eye - at) - haze.w) / haze.w, 0.0, 1.0);
  color = vec4(mix(min(shade, vec3(1.0)), haze.rgb, far), min(1.0, paint.a + edge + gloss));
})";

Eigen::Matrix4d perspective(double fov_rad, double aspect, double near_m, double far_m) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  const double f = 1 / std::tan(0.5 * fov_rad);
  m(0, 0) = f / aspect;
  m(1, 1) = -f;  // rows run down the picture
  m(2, 2) = (far_m + near_m) / (near_m - far_m);
  m(2, 3) = 2 * far_m * near_m / (near_m - far_m);
  m(3, 2) = -1;
  return m;
}

Eigen::Matrix4d look_at(const Vector3d& eye, const Vector3d& target) {
  const Vector3d back = (eye - target).normalized(), right = Vector3d::UnitZ().cross(back).normalized(),
                 up = back.cross(right);
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = right.transpose();
  m.block<1, 3>(1, 0) = up.transpose();
  m.block<1, 3>(2, 0) = back.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye;
  return m;
}

struct Eye {
  Vector3d eye, target;
};

// The rig stands below its arm; a buoy's mast stands above the highest crest.
Eye eye_of(const SceneSettings& s, const RigMotion& motion) {
  const double reach = motion.radius_m() + 0.45;
  const Vector3d target(0, 0, (motion.on_sea() ? 0.05 : -0.32) * reach);
  const double distance = (motion.on_sea() ? 4.1 : 3.6) * reach;
  const double ch = std::cos(s.view_height_rad);
  return {target + distance * Vector3d(ch * std::sin(s.view_azimuth_rad), -ch * std::cos(s.view_azimuth_rad),
                                       std::sin(s.view_height_rad)),
          target};
}

}  // namespace

struct RigScene::Buffers {
  GLuint program = make_program(kVertexShader, kFragmentShader);
  GLuint vertex_array = 0, vertices = 0, indices = 0;
  Buffers() {
    glGenVertexArrays(1, &vertex_array);
    glGenBuffers(1, &vertices);
    glGenBuffers(1, &indices);
    glBindVertexArray(vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
    const auto attribute = [](GLuint index, GLint size, std::size_t offset) {
      glEnableVertexAttribArray(index);
      glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(MeshVertex),
                            reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, offsetof(MeshVertex, position));
    attribute(1, 3, offsetof(MeshVertex, normal));
    attribute(2, 4, offsetof(MeshVertex, color));
  }
  ~Buffers() {
    glDeleteBuffers(1, &vertices);
    glDeleteBuffers(1, &indices);
    glDeleteVertexArrays(1, &vertex_array);
    glDeleteProgram(program);
  }
  void draw(const Mesh& mesh) const {
    glBindVertexArray(vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(MeshVertex)),
                 mesh.vertices.data(), GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(),
                 GL_STREAM_DRAW);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indices.size()), GL_UNSIGNED_INT, nullptr);
  }
};

RigScene::RigScene(Canvas& canvas, const SceneSettings& settings)
    : canvas_(canvas), settings_(settings), parts_(settings.theme), project_(Eigen::Matrix4d::Identity()) {
  canvas.context().make_current();
  buffers_ = std::make_unique<Buffers>();
}

RigScene::~RigScene() { canvas_.context().make_current(); }

void RigScene::prepare_fonts(float text_px) {
  canvas_.fonts().require(text_px, false);
  canvas_.fonts().require(text_px, true);
}

void RigScene::draw(const RigMotion& motion, const RigInstant& instant, const RenderTarget& target,
                    const Rect& area, float text_px) {
  canvas_.context().make_current();
  const int width = static_cast<int>(area.width()), height = static_cast<int>(area.height());
  const int large_width = kSupersampling * width, large_height = kSupersampling * height;
  if (!large_ || large_->width_px() != large_width || large_->height_px() != large_height) {
    large_.reset();
    large_ = std::make_unique<RenderTarget>(large_width, large_height, true);
  }
  const Eye eye = eye_of(settings_, motion);
  const double aspect = static_cast<double>(width) / height;
  // The circle of the arm fits into the narrower side.
  const double fov = 2 * std::atan(std::tan(0.5 * 40 * std::numbers::pi / 180) * std::max(1.0, 1.0 / aspect));
  const double distance = (eye.eye - eye.target).norm();
  project_ = perspective(fov, aspect, 0.1, std::max(60.0, 3 * distance)) * look_at(eye.eye, eye.target);
  parts_.build(motion, instant);

  const Color sky = settings_.theme == Theme::kDark ? rgb(0x14181D) : rgb(0xF3F6F9);
  large_->bind();
  glDisable(GL_SCISSOR_TEST);
  glClearColor(sky.r, sky.g, sky.b, 1);
  glClearDepth(1);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glUseProgram(buffers_->program);
  const Eigen::Matrix4f project = project_.cast<float>();
  glUniformMatrix4fv(glGetUniformLocation(buffers_->program, "project"), 1, GL_FALSE, project.data());
  const Eigen::Vector3f eye_f = eye.eye.cast<float>(), lamp = SceneParts::towards_lamp().cast<float>();
  glUniform3fv(glGetUniformLocation(buffers_->program, "eye"), 1, eye_f.data());
  glUniform3fv(glGetUniformLocation(buffers_->program, "lamp"), 1, lamp.data());
  glUniform4f(glGetUniformLocation(buffers_->program, "haze"), sky.r, sky.g, sky.b,
              static_cast<float>(1.25 * distance));
  glDisable(GL_BLEND);
  buffers_->draw(parts_.solid);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  buffers_->draw(parts_.clear);
  glDisable(GL_DEPTH_TEST);

  // Two by two pixels become one: the linear filter of the blit averages
  // exactly four.
  glBindFramebuffer(GL_READ_FRAMEBUFFER, large_->framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
  const int left = static_cast<int>(area.left), top = static_cast<int>(area.top);
  glBlitFramebuffer(0, 0, large_width, large_height, left, top, left + width, top + height,
                    GL_COLOR_BUFFER_BIT, GL_LINEAR);
  if (settings_.labels) draw_labels(motion, instant, target, area, text_px);
}

void RigScene::draw_labels(const RigMotion& motion, const RigInstant& at, const RenderTarget& target,
                           const Rect& area, float text_px) {
  const ThemeColors& colors = theme_colors(settings_.theme);
  const auto on_page = [&](const Vector3d& p) {
    const Eigen::Vector4d clip = project_ * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
    return Vec2{area.left + area.width() * static_cast<float>(0.5 + 0.5 * clip.x() / clip.w()),
                area.top + area.height() * static_cast<float>(0.5 + 0.5 * clip.y() / clip.w())};
  };
  canvas_.draw_over(target, [&](Painter& painter) {
    // A scale of heights beside the rig, with truth and estimate on it.
    const double r = motion.radius_m(), low = -r, high = r, gap = 0.08 * (r + 0.3);
    double x = 1.55 * (r + 0.3);
    while (x > 1.1 * r && on_page({x + gap, 0, high}).x + 4.5F * text_px > area.right) x *= 0.97;
    const Color truth = colors.ink, estimate = palette(settings_.theme, motion.color());
    const auto line = [&](const Vector3d& a, const Vector3d& b, Color color, float width) {
      painter.stroke(std::array{on_page(a), on_page(b)}, color, width);
    };
    const float thin = std::max(1.0F, 0.09F * text_px);
    // In full ink: some of it stands on the water.
    line({x, 0, low}, {x, 0, high}, colors.ink, thin);
    const double step = nice_step(high - low, 4);
    for (double z = std::ceil(low / step - 1e-9) * step; z <= high + 1e-9; z += step) {
      line({x, 0, z}, {x + 0.05 * (r + 0.3), 0, z}, colors.ink, thin);
      const Vec2 p = on_page({x + gap, 0, z});
      // Off its stroke, or that would be read as a second minus.
      painter.text({p.x + 0.5F * text_px, p.y},
                   number_text(100 * z, 0) + (z + step > high + 1e-9 ? " cm" : ""),
                   {.size_px = text_px, .color = colors.ink, .v = VAlign::kMiddle});
    }
    const auto pointer = [&](double z, Color color, float grown) {
      const Vec2 tip = on_page({x, 0, z});
      const float s = 0.75F * grown * text_px;
      painter.fill_convex(
          std::array<Vec2, 3>{{tip, {tip.x - s, tip.y - 0.5F * s}, {tip.x - s, tip.y + 0.5F * s}}}, color);
    };
    if (at.estimated) pointer(at.estimated_heave_m, estimate, 1.7F);
    pointer(at.sensor_m.z(), truth, 1);

    // What is what, lower left.
    float y = area.bottom - 0.8F * text_px;
    const auto entry = [&](const std::string& text, Color color) {
      painter.fill_rect({area.left + text_px, y - 0.75F * text_px, area.left + 1.75F * text_px, y}, color);
      painter.text({area.left + 2.2F * text_px, y}, text, {.size_px = text_px, .color = colors.ink});
      y -= 1.5F * text_px;
    };
    if (at.estimated)
      entry(fmt::format("estimate of {}, {} cm", motion.method(), number_text(100 * at.estimated_heave_m, 1)),
            estimate);
    entry(fmt::format("true heave, {} cm", number_text(100 * at.sensor_m.z(), 1)), truth);
    painter.text({area.left + text_px, area.top + text_px}, fmt::format("t = {:.1f} s", at.time_s),
                 {.size_px = text_px, .color = colors.ink, .v = VAlign::kTop, .bold = true});
    painter.text({area.right - text_px, area.top + text_px},
                 fmt::format(fmt::runtime(motion.on_sea() ? "Tp {:g} s, Hm0 {:g} cm, repeat {}"
                                                          : "{:g} s, {:g} cm, repeat {}"),
                             motion.run().period_s, 100 * motion.run().height_m, motion.run().repeat + 1),
                 {.size_px = text_px, .color = colors.faint_ink, .h = HAlign::kRight, .v = VAlign::kTop});
  });
}

}  // namespace waverig::render
