#include "render/stroke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace waverig::render {

void stroke_dashed(Painter& painter, std::span<const Vec2> points, Color color, float width_px, Dash dash) {
  if (dash == Dash::kSolid || points.size() < 2) return painter.stroke(points, color, width_px);
  const float unit = std::max(width_px, 1.0F);
  const std::array<float, 2> lengths =
      dash == Dash::kDashed ? std::array{4.5F * unit, 3.0F * unit} : std::array{1.0F * unit, 2.2F * unit};
  std::size_t part = 0;  // 0 drawn, 1 gap
  float left = lengths[0];
  std::vector<Vec2> piece = {points[0]};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Vec2 from = points[i];
    const Vec2 to = points[i + 1];
    float rest = std::hypot(to.x - from.x, to.y - from.y);
    while (rest > left) {
      from = {from.x + (to.x - from.x) * left / rest, from.y + (to.y - from.y) * left / rest};
      rest -= left;
      if (part == 0) {
        piece.push_back(from);
        painter.stroke(piece, color, width_px);
        piece.clear();
      } else {
        piece = {from};
      }
      part = 1 - part;
      left = lengths[part];
    }
    left -= rest;
    if (part == 0) piece.push_back(to);
  }
  if (part == 0 && piece.size() > 1) painter.stroke(piece, color, width_px);
}

std::vector<Vec2> arc(Vec2 centre, float radius_px, double from_rad, double to_rad) {
  const int parts =
      std::clamp(static_cast<int>(std::abs(to_rad - from_rad) * std::sqrt(radius_px) * 2), 6, 200);
  std::vector<Vec2> points;
  for (int k = 0; k <= parts; ++k) {
    const double angle = from_rad + (to_rad - from_rad) * k / parts;
    points.push_back({centre.x + radius_px * static_cast<float>(std::sin(angle)),
                      centre.y - radius_px * static_cast<float>(std::cos(angle))});
  }
  return points;
}

void draw_marker(Painter& painter, Vec2 at, Marker marker, float size_px, Color color, Color background) {
  const float r = 0.5F * size_px, thin = std::max(1.0F, 0.22F * size_px);
  const auto polygon = [&](std::initializer_list<Vec2> corners) {
    std::vector<Vec2> shifted;
    for (const Vec2 c : corners) shifted.push_back({at.x + r * c.x, at.y + r * c.y});
    painter.fill_convex(shifted, color);
  };
  switch (marker) {
    case Marker::kNone:
      return;
    case Marker::kCircle:
    case Marker::kHollowCircle: {
      std::vector<Vec2> circle = arc(at, r, 0, 2 * std::numbers::pi);
      circle.pop_back();
      painter.fill_convex(circle, color);
      if (marker == Marker::kHollowCircle && r > thin) {
        circle = arc(at, r - thin, 0, 2 * std::numbers::pi);
        circle.pop_back();
        painter.fill_convex(circle, background);
      }
      return;
    }
    case Marker::kSquare:
      return polygon({{-0.9F, -0.9F}, {0.9F, -0.9F}, {0.9F, 0.9F}, {-0.9F, 0.9F}});
    case Marker::kTriangle:
      return polygon({{0, -1.1F}, {1, 0.75F}, {-1, 0.75F}});
    case Marker::kDiamond:
      return polygon({{0, -1.2F}, {1.2F, 0}, {0, 1.2F}, {-1.2F, 0}});
    case Marker::kCross: {
      const std::array<Vec2, 2> a = {{{at.x - r, at.y - r}, {at.x + r, at.y + r}}};
      const std::array<Vec2, 2> b = {{{at.x - r, at.y + r}, {at.x + r, at.y - r}}};
      painter.stroke(a, color, thin);
      painter.stroke(b, color, thin);
    }
  }
}

}  // namespace waverig::render
