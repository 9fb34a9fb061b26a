// Legends that avoid the data: the panel is drawn coarsely onto a grid first,
// and the legend takes a free place.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "render/panel_view.h"

namespace waverig::render {

struct LegendEntry {
  std::string name;                // fitted to the panel
  std::vector<std::size_t> marks;  // marks of one name share an entry
};

struct LegendPlan {
  std::vector<LegendEntry> entries;
  Rect box;              // in pixels
  int columns = 1;       // entries side by side, inside
  bool outside = false;  // over the panel, under a polar one: line by line, as many entries as fit
};

// Of the marks that show something.
std::vector<LegendEntry> legend_entries(const Panel& panel, float most_px, const FontBook& fonts,
                                        float text_pt);
// Where the entries of a legend outside its panel stand: x from its left, line
// from the top.
struct LegendSpot {
  float x_px = 0;
  int line = 0;
};
std::vector<LegendSpot> flowed(const std::vector<LegendEntry>& entries, float width_px, const FontBook& fonts,
                               float text_pt);
float legend_height_px(int lines, float text_pt);

// A box inside the plot that hides nothing; none where there is no room.
// `draw_marks` paints the panel's data.
struct FreePlace {
  Rect box;
  int columns = 1;
};
std::optional<FreePlace> free_place(const PanelView& view, const std::vector<LegendEntry>& entries,
                                    const std::vector<Color>& colors);

void draw_legend(const LegendPlan& legend, const std::vector<Color>& colors, const PanelView& view);

}  // namespace waverig::render
