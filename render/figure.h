// A figure as plain values: panels of marks on two axes. Nothing here draws;
// see figure_writer.h.
//
//   Figure figure{.title = "Heave"};
//   figure.panels.push_back({.x = {.label = "Time", .unit = "s"}, .y = {.label
//   = "Heave", .unit = "m"},
//                            .marks = {Line{.x = t_s, .y = heave_m, .name =
//                            "truth"}}});
//   Canvas canvas;
//   save_png(figure, canvas, "heave.png", {});
//
// Every mark takes what it gets: NaN breaks a line, unequal lengths are cut to
// the shorter, an empty panel says so.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/color.h"

namespace waverig::render {

inline constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();
inline constexpr int kNextColor = -1;
inline constexpr int kInk = -2;       // the theme's text colour
inline constexpr int kFaintInk = -3;  // the same, fainter: bounds, references

// kTime: seconds since 1970, shown as UTC. kSignedLog: of a heat map's colours alone.
enum class Scale { kLinear, kLog, kTime, kSignedLog };

// Neighbouring places 0, 1, 2, … of an axis under one name.
struct AxisGroup {
  std::string name;
  std::size_t places = 1;
};

struct Axis {
  std::string label{};
  std::string unit{};  // shown in brackets behind the label
  Scale scale = Scale::kLinear;
  double low = kAuto,
         high = kAuto;                    // limits; equal or reversed ones are put right
  std::vector<std::string> categories{};  // names at 0, 1, 2, … instead of
                                          // numbers; '\n' breaks a name
  std::vector<AxisGroup> groups{};        // instead of categories where those are too many to be named
  double padding = kAuto;                 // share of the range left free at both ends
  bool include_zero = false;
  bool whole_numbers = false;  // ticks at integers only
};

enum class Dash { kSolid, kDashed, kDotted };
enum class Marker { kNone, kCircle, kSquare, kTriangle, kDiamond, kCross, kHollowCircle };

struct Look {
  int color = kNextColor;  // number in the palette, kNextColor, kInk or kFaintInk
  double width_pt = 1.0;
  Dash dash = Dash::kSolid;
  Marker marker = Marker::kNone;
  double marker_pt = 4.0;
  double alpha = 1.0;
  double ramp = kAuto;  // 0 to 1: a place among series that have an order, instead of color
};

struct Line {
  std::vector<double> x{}, y{};
  std::string name{};  // in the legend; empty: not listed. The same in every mark.
  Look look{};
};

struct Points {
  std::vector<double> x{}, y{};
  std::string name{};
  Look look{.marker = Marker::kCircle};
};

struct Bars {
  std::vector<double> at{}, value{};
  std::string name{};
  Look look{};
  std::vector<double> base{};  // where each begins, 0 by default; a single one holds for all
  double width = 0.8;          // in units of the axis
  bool horizontal = false;     // `at` along y
};

struct ErrorBars {
  std::vector<double> x{}, y{}, minus{}, plus{};  // minus and plus are lengths from y
  std::string name{};
  Look look{};
  bool horizontal = false;  // lengths along x
};

struct Band {
  std::vector<double> x{}, low{}, high{};
  std::string name{};
  Look look{.alpha = 0.25};
};

struct Histogram {
  std::vector<double> values{};
  std::string name{};
  Look look{.alpha = 0.75};
  int bins = 0;          // 0: Freedman & Diaconis (1981)
  bool density = false;  // area 1 instead of counts
};

struct HeatMap {
  std::vector<double> x_edges{}, y_edges{};  // one more than cells
  std::vector<double> values{};              // row by row of y, NaN left blank
  std::string label{}, unit{};               // of the colour bar
  ColorMap map = ColorMap::kSequential;
  double low = kAuto, high = kAuto;  // of the colour bar; diverging: symmetric
                                     // about 0 by default
  bool log_colors = false;
  double knee = kAuto;    // of diverging colours: linear about 0 up to here, logarithmic beyond
  bool color_bar = true;  // false where another panel's bar serves
  int decimals = -1;      // of the number written into each cell, fewer where they do not fit; on logarithmic
                          // colours its significant digits, at least two; -1: none
  std::vector<std::string>
      signs{};  // behind the numbers, or alone where a cell has none; a figure explains them
};

// A straight line right across the panel.
struct Rule {
  double at = 0;
  bool vertical = false;
  std::string label{};  // written along the line
  std::string name{};
  Look look{.color = kFaintInk, .width_pt = 0.8, .dash = Dash::kDashed};
};

// A shaded part of the axis, e.g. the ramps of a run.
struct Span {
  double from = 0, to = 0;
  bool vertical = true;  // from and to lie on x
  std::string name{};
  Look look{.color = kFaintInk, .alpha = 0.12};
};

struct Note {
  double x = 0.02, y = 0.98;  // share of the panel from its lower left corner,
                              // or data where in_data is set
  std::string text{};         // '\n' breaks it
  bool in_data = false;
  int color = kInk;
  bool boxed = false;
};

using Mark = std::variant<Line, Points, Bars, ErrorBars, Band, Histogram, HeatMap, Rule, Span, Note>;

enum class Legend { kFree, kAbove, kNone };  // kFree: inside where it hides no data, above otherwise

struct Panel {
  std::string title{};
  Axis x{}, y{};
  std::vector<Mark> marks{};
  bool polar = false;         // x is an angle in rad clockwise from the top, y the radius
  bool compass = false;       // a polar panel shows N, E, S, W instead of degrees
  bool equal_scales = false;  // a unit of x is as long as a unit of y
  Legend legend = Legend::kFree;
  int column_span = 1;
};

struct Figure {
  std::string title{}, subtitle{};
  std::vector<Panel> panels{};  // row by row
  int columns = 1;
  std::vector<double> row_heights{};       // relative; missing ones are 1
  bool share_x = false;                    // the panels of a column share their x axis; the lowest shows it
  double width_mm = 174, height_mm = 110;  // a journal's full text width
  double dots_per_inch = 200;
  Theme theme = Theme::kPrint;
  double text_scale = 1;
};

}  // namespace waverig::render
