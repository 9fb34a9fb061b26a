#include "render/draw_list_painter.h"

#include <array>
#include <cmath>
#include <vector>

namespace waverig::render {
namespace {

ImU32 packed(Color c) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, c.a}); }
Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
Vec2 operator*(float k, Vec2 a) { return {k * a.x, k * a.y}; }
float dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
Vec2 left_of(Vec2 d) { return {d.y, -d.x}; }

// One antialiased line of a draw list: rows of two vertices across it. In place of a texel each carries its
// distance from the line's middle and, negative, the distance where the line has faded: the canvas' shader
// tells the coverage from them.
class Ribbon {
 public:
  Ribbon(ImDrawList& list, Color color, float width_px)
      : list_(list),
        full_(packed(color)),
        clear_(packed(with_alpha(color, 0))),
        outer_(0.5F * std::max(width_px, 1.0F) + 0.5F) {
    // A line thinner than a pixel is one pixel wide and paler.
    if (width_px < 1) full_ = packed(with_alpha(color, color.a * width_px));
  }
  float half() const { return outer_ - 0.5F; }
  void begin() { joined_ = false; }
  // across: perpendicular to the line, of length 1 (more at a mitre).
  void row(Vec2 at, Vec2 across, bool visible) {
    const auto vertex = [&](float distance) {
      const Vec2 p = at + distance * across;
      return ImDrawVert{{p.x, p.y}, {distance, -outer_}, visible ? full_ : clear_};
    };
    const std::array<ImDrawVert, 2> vertices = {vertex(-outer_), vertex(outer_)};
    if (joined_ &&
        list_._VtxCurrentIdx + 2 >= 1U << 16U) {  // a new block of 16-bit indices: the last row again
      list_.PrimReserve(0, 2);
      for (const ImDrawVert& v : last_) list_.PrimWriteVtx(v.pos, v.uv, v.col);
    }
    list_.PrimReserve(joined_ ? 6 : 0, 2);
    if (joined_) {
      const unsigned b = list_._VtxCurrentIdx, a = b - 2;
      for (const unsigned i : {a, a + 1, b + 1, a, b + 1, b}) list_.PrimWriteIdx(static_cast<ImDrawIdx>(i));
    }
    for (const ImDrawVert& v : vertices) list_.PrimWriteVtx(v.pos, v.uv, v.col);
    last_ = vertices;
    joined_ = true;
  }

 private:
  ImDrawList& list_;
  ImU32 full_, clear_;
  float outer_ = 0;  // px from the middle to where nothing is left
  std::array<ImDrawVert, 2> last_{};
  bool joined_ = false;
};

}  // namespace

DrawListPainter::DrawListPainter(FontBook& fonts, int width_px, int height_px)
    : fonts_(fonts), list_(&shared_) {
  shared_.TexUvWhitePixel = fonts.atlas().TexUvWhitePixel;
  shared_.ClipRectFullscreen = {0, 0, static_cast<float>(width_px), static_cast<float>(height_px)};
  shared_.InitialFlags = ImDrawListFlags_AntiAliasedFill | ImDrawListFlags_AllowVtxOffset;
  shared_.SetCircleTessellationMaxError(0.1F);
  list_._ResetForNewFrame();
  list_.PushTextureID(fonts.atlas().TexID);
  list_.PushClipRectFullScreen();
}

// Mitred where the line turns gently; where it turns back sharply the ribbon
// ends half a width beyond the point and a new one begins, so that a spike of
// one sample keeps its full height.
void DrawListPainter::stroke(std::span<const Vec2> points, Color color, float width_px) {
  constexpr float kCoincident = 0.02F,
                  kSharpest = 0.2F;  // px; cosine of the turn
  std::vector<Vec2> line;
  line.reserve(points.size());
  for (const Vec2 p : points) {
    if (line.empty() || dot(p - line.back(), p - line.back()) > kCoincident * kCoincident) line.push_back(p);
  }
  Ribbon ribbon(list_, color, width_px);
  if (line.size() == 1) {
    const Vec2 d = {ribbon.half(), 0};
    line = {line[0] - d, line[0] + d};
  }
  const auto cap = [&ribbon](Vec2 at, Vec2 outwards, Vec2 across, bool opening) {
    const Vec2 edge = at + (ribbon.half() - 0.5F) * outwards, beyond = at + (ribbon.half() + 0.5F) * outwards;
    ribbon.row(opening ? beyond : edge, across, !opening);
    ribbon.row(opening ? edge : beyond, across, opening);
  };
  Vec2 before{};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec2 step = line[i + 1] - line[i];
    const Vec2 along = (1 / std::sqrt(dot(step, step))) * step;
    const float turn = i == 0 ? -1 : dot(before, along);
    if (turn > kSharpest) {
      ribbon.row(line[i], (1 / (1 + turn)) * (left_of(before) + left_of(along)), true);
    } else {
      if (i > 0) ribbon.row(line[i] + ribbon.half() * before, left_of(before), true);
      ribbon.begin();
      if (i > 0)
        ribbon.row(line[i] - ribbon.half() * along, left_of(along), true);
      else
        cap(line[i], -1.0F * along, left_of(along), true);
    }
    before = along;
  }
  if (line.size() >= 2) cap(line.back(), before, left_of(before), false);
}

void DrawListPainter::fill_convex(std::span<const Vec2> corners, Color color) {
  std::vector<ImVec2> points;
  for (const Vec2 p : corners) points.emplace_back(p.x, p.y);
  list_.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), packed(color));
}

// Neighbouring quads share their edge exactly, so no seam shows where the
// colour is transparent.
void DrawListPainter::fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) {
  const ImU32 c = packed(color);
  const ImVec2 uv = shared_.TexUvWhitePixel;
  for (std::size_t i = 0; i + 1 < upper.size(); ++i) {
    list_.PrimReserve(6, 4);
    list_.PrimQuadUV({upper[i].x, upper[i].y}, {upper[i + 1].x, upper[i + 1].y},
                     {lower[i + 1].x, lower[i + 1].y}, {lower[i].x, lower[i].y}, uv, uv, uv, uv, c);
  }
}

void DrawListPainter::fill_rect(const Rect& rect, Color color) {
  list_.AddRectFilled({rect.left, rect.top}, {rect.right, rect.bottom}, packed(color));
}

void DrawListPainter::text(Vec2 at, std::string_view utf8, const TextStyle& style) {
  const ImFont& font = fonts_.font(style.size_px, style.bold);
  const float width = fonts_.width_px(utf8, style.size_px, style.bold);
  const float cap = kCapHeight * style.size_px;
  const float along = style.h == HAlign::kLeft ? 0 : style.h == HAlign::kCenter ? -0.5F * width : -width;
  const float down = style.v == VAlign::kBaseline ? 0 : style.v == VAlign::kMiddle ? 0.5F * cap : cap;
  const float origin_x = std::round(at.x), origin_y = std::round(at.y);
  // In a frame where the text runs right and its baseline lies at 0; whole
  // pixels, so that texels fall on pixels.
  float pen = std::round(along);
  const float top = std::round(down) - std::round(font.Ascent);
  const ImU32 color = packed(style.color);
  for_each_character(utf8, [&](ImWchar c) {
    const ImFontGlyph& glyph = *font.FindGlyph(c);
    if (glyph.Visible) {
      const float x = std::floor(pen + 0.5F);
      const auto turned = [&](float u, float v) {
        return style.upwards ? ImVec2(origin_x + v, origin_y - u) : ImVec2(origin_x + u, origin_y + v);
      };
      list_.PrimReserve(6, 4);
      list_.PrimQuadUV(turned(x + glyph.X0, top + glyph.Y0), turned(x + glyph.X1, top + glyph.Y0),
                       turned(x + glyph.X1, top + glyph.Y1), turned(x + glyph.X0, top + glyph.Y1),
                       {glyph.U0, glyph.V0}, {glyph.U1, glyph.V0}, {glyph.U1, glyph.V1}, {glyph.U0, glyph.V1},
                       color);
    }
    pen += glyph.AdvanceX;
  });
}

void DrawListPainter::push_clip(const Rect& rect) {
  list_.PushClipRect({std::floor(rect.left), std::floor(rect.top)},
                     {std::ceil(rect.right), std::ceil(rect.bottom)}, true);
}

void DrawListPainter::pop_clip() { list_.PopClipRect(); }

}  // namespace waverig::render
