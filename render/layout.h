// Where everything of a figure goes: limits, ticks, margins, legends. Nothing
// is drawn here.
#pragma once
#include <string>
#include <vector>

#include "render/legend.h"
#include "render/marks.h"
#include "render/ticks.h"

namespace waverig::render {

struct Margins {
  float left = 0, right = 0, top = 0, bottom = 0;
};

struct PanelPlan {
  Panel panel;                // histograms resolved
  std::vector<Color> colors;  // of its marks
  Mapping x, y;
  Ticks x_ticks, y_ticks;
  bool has_data = false;
  bool shows_x_labels = true;
  int row = 0, column = 0;
  Margins margins;
  Rect plot;
  float title_bottom = 0;  // right above the plot, or the legend over it
  float label_left = 0;    // where the y labels of its column begin
  LegendPlan legend;
  const HeatMap* heat = nullptr;  // into panel.marks: gets a colour bar
  float bar_bottom = 0;           // of that bar, which is as high as all maps that share it
};

struct FigurePlan {
  int width_px = 0, height_px = 0;
  float pt = 1, text_pt = 1;
  std::vector<std::string> title_lines, subtitle_lines;
  std::vector<PanelPlan> panels;
};

// Throws UserError where the size makes no picture.
FigurePlan planned(const Figure& figure, const FontBook& fonts);
PanelView view_of(const PanelPlan& plan, const FigurePlan& figure, Painter& painter, const FontBook& fonts,
                  Theme theme);

// Pixel size of the figure; throws UserError where it makes no picture.
void pixel_size(const Figure& figure, int& width_px, int& height_px);

}  // namespace waverig::render
