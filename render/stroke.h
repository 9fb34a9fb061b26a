// Dashes and markers out of the painter's plain strokes and fills.
#pragma once
#include "render/figure.h"
#include "render/painter.h"

namespace waverig::render {

void stroke_dashed(Painter& painter, std::span<const Vec2> points, Color color, float width_px, Dash dash);
void draw_marker(Painter& painter, Vec2 at, Marker marker, float size_px, Color color, Color background);
// A circle or a part of one, from angle to angle, clockwise from the top.
std::vector<Vec2> arc(Vec2 centre, float radius_px, double from_rad, double to_rad);

}  // namespace waverig::render
