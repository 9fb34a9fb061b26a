// Fewer points for the same picture of a dense series.
#pragma once
#include <vector>

#include "render/painter.h"

namespace waverig::render {

// Where x never falls and a pixel column holds more than three points, the
// column keeps its lowest and its highest in their order: every extreme
// survives, so a spike of one sample stays as high as it is. Points come in
// pixels; a series whose x falls somewhere is returned as it is.
std::vector<Vec2> decimated(std::vector<Vec2> points);

}  // namespace waverig::render
