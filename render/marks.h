// How each mark of a figure takes its place on the axes and is drawn.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "render/panel_view.h"

namespace waverig::render {

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool empty() const { return low > high; }
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Extent& other) {
    add(other.low);
    add(other.high);
  }
};

// Whether a value has a place on an axis.
inline bool fits(double value, Scale scale) {
  return std::isfinite(value) && (scale != Scale::kLog || value > 0);
}
inline double base_of(const Bars& bars, std::size_t i) {
  return bars.base.empty() ? 0 : bars.base[std::min(i, bars.base.size() - 1)];
}

// What a mark needs of both axes. On a logarithmic axis only positive values
// count.
struct MarkExtents {
  Extent x, y;
  bool pad_x = false, pad_y = true;  // free space at the ends: points want it
                                     // along x, heat maps nowhere
  bool on_base = false;              // bars: an end of their axis that is their base stays there
  bool has_data = false;
};
MarkExtents extents_of(const Mark& mark, Scale x_scale, Scale y_scale);

// Histograms become bars.
Mark resolved(const Mark& mark);
Bars bars_of(const Histogram& histogram);

// Palette colours given out in order to the marks that ask for the next one.
std::vector<Color> colors_of(const std::vector<Mark>& marks, Theme theme);

void draw_mark(const Mark& mark, Color color, const PanelView& view);

const std::string& name_of(const Mark& mark);  // empty: not in the legend
void draw_swatch(const Mark& mark, Color color, const PanelView& view, const Rect& place);

// The limits of a heat map's colours and the colour of one value.
struct ColorScale {
  Mapping mapping;
  ColorMap map;
  Color at(double value) const { return color_of(map, mapping.share(value)); }
};
ColorScale color_scale_of(const HeatMap& heat);

}  // namespace waverig::render
