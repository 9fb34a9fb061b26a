#include "render/layout.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/error.h"
#include "render/axis.h"
#include "render/occupancy.h"
#include "render/text_fit.h"

namespace waverig::render {
namespace {

constexpr float kEdge = 6, kGap = 9, kTickLength = 3, kTickGap = 2.5F;  // points
constexpr float kColorBarGap = 7, kColorBarWidth = 9;
constexpr float kRimText = 14;  // around a polar plot: degrees or points of the compass

float line_height(float size_px) { return 1.3F * size_px; }

int most_lines(const Ticks& ticks) {
  long most = 1;
  for (const Tick& t : ticks.major)
    most = std::max(most, 1 + std::count(t.label.begin(), t.label.end(), '\n'));
  return static_cast<int>(most);
}

// '\n' breaks a label.
float label_width(const std::string& label, const FontBook& fonts, float size_px) {
  float widest = 0;
  for (std::size_t from = 0; from <= label.size();) {
    const std::size_t to = std::min(label.find('\n', from), label.size());
    widest = std::max(widest, fonts.width_px(std::string_view(label).substr(from, to - from), size_px));
    from = to + 1;
  }
  return widest;
}

float widest_label(const Ticks& ticks, const FontBook& fonts, float size_px) {
  float widest = 0;
  for (const Tick& t : ticks.major) widest = std::max(widest, label_width(t.label, fonts, size_px));
  return widest;
}

// Names of categories side by side: wrapped, each into the room up to its named neighbours. Where many do not
// fit, every second is left out, every third…; where few, they are shortened.
void fit_categories(std::vector<Tick>& ticks, float pitch_px, const FontBook& fonts, float size_px) {
  constexpr std::size_t kMany = 8;
  const std::vector<Tick> given = ticks;
  for (std::size_t every = 1; every < std::max<std::size_t>(2, given.size()); ++every) {
    std::vector<std::size_t> named;
    for (std::size_t i = 0; i < given.size(); i += every) {
      if (!given[i].label.empty()) named.push_back(i);
    }
    ticks = given;
    for (Tick& t : ticks) t.label.clear();
    bool whole = true;
    for (std::size_t k = 0; k < named.size(); ++k) {
      std::size_t apart = given.size();
      if (k > 0) apart = std::min(apart, named[k] - named[k - 1]);
      if (k + 1 < named.size()) apart = std::min(apart, named[k + 1] - named[k]);
      const std::string& name = given[named[k]].label;
      std::string& label = ticks[named[k]].label;
      for (const std::string& line :
           wrapped(name, pitch_px * static_cast<float>(apart) - 0.6F * size_px, 3, fonts, size_px))
        label += (label.empty() ? "" : "\n") + line;
      whole &= label.find("\u2026") == std::string::npos || name.find("\u2026") != std::string::npos;
    }
    if (whole || given.size() <= kMany) return;
  }
}

class Planner {
 public:
  Planner(const Figure& figure, const FontBook& fonts) : figure_(figure), fonts_(fonts) {
    pixel_size(figure, plan_.width_px, plan_.height_px);
    plan_.pt = static_cast<float>(figure.dots_per_inch / 72);
    plan_.text_pt = plan_.pt * static_cast<float>(figure.text_scale);
    place_panels();
    limits();
  }

  FigurePlan run() {
    const float width = static_cast<float>(plan_.width_px) - 2 * kEdge * plan_.pt;
    plan_.title_lines = wrapped(figure_.title, width, 3, fonts_, kTitleText * plan_.text_pt, true);
    plan_.subtitle_lines = wrapped(figure_.subtitle, width, 4, fonts_, kSubtitleText * plan_.text_pt);
    for (PanelPlan& p : plan_.panels) p.margins = {30 * plan_.pt, 4 * plan_.pt, 12 * plan_.pt, 26 * plan_.pt};
    // Margins depend on tick labels, those on the room the margins leave: three
    // rounds settle it.
    for (int round = 0; round < 3; ++round) {
      arrange();
      for (PanelPlan& p : plan_.panels) measure(p);
    }
    arrange();
    place_legends();
    for (PanelPlan& p : plan_.panels) measure(p);
    arrange();
    for (PanelPlan& p : plan_.panels) finish_legend(p);
    return std::move(plan_);
  }

 private:
  void place_panels() {
    const int columns = std::max(1, figure_.columns);
    int row = 0, column = 0;
    for (const Panel& panel : figure_.panels) {
      const int span = std::clamp(panel.column_span, 1, columns);
      if (column + span > columns) {
        ++row;
        column = 0;
      }
      PanelPlan& p = plan_.panels.emplace_back();
      p.panel = panel;
      p.panel.column_span = span;
      for (Mark& mark : p.panel.marks) mark = resolved(mark);
      p.colors = colors_of(p.panel.marks, figure_.theme);
      p.row = row;
      p.column = column;
      column += span;
      rows_ = row + 1;
    }
    for (PanelPlan& p : plan_.panels) {
      for (const Mark& mark : p.panel.marks) {
        if (const auto* heat = std::get_if<HeatMap>(&mark);
            heat != nullptr && p.heat == nullptr && heat->color_bar)
          p.heat = heat;
      }
      if (!figure_.share_x) continue;
      for (const PanelPlan& q : plan_.panels) p.shows_x_labels &= q.column != p.column || q.row <= p.row;
    }
  }

  void limits() {
    std::vector<MarkExtents> all;
    for (const PanelPlan& p : plan_.panels) {
      MarkExtents sum;
      sum.pad_y = false;
      for (const Mark& mark : p.panel.marks) {
        const MarkExtents e = extents_of(mark, p.panel.x.scale, p.panel.y.scale);
        sum.x.add(e.x);
        sum.y.add(e.y);
        sum.has_data |= e.has_data;
        sum.pad_x |= e.has_data && e.pad_x;
        sum.pad_y |= e.has_data && e.pad_y;
        sum.on_base |= e.on_base;
      }
      all.push_back(sum);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      PanelPlan& p = plan_.panels[i];
      p.has_data = all[i].has_data;
      Extent x = all[i].x;
      bool pad_x = all[i].pad_x, on_base = all[i].on_base;
      for (std::size_t k = 0; figure_.share_x && k < all.size(); ++k) {
        if (plan_.panels[k].column != p.column) continue;
        x.add(all[k].x);
        pad_x |= all[k].pad_x;
        on_base |= all[k].on_base;
      }
      set_limits(p.panel.x, x, pad_x && !p.panel.polar, on_base, p.x);
      set_limits(p.panel.y, all[i].y, all[i].pad_y && !p.panel.polar, all[i].on_base, p.y);
    }
  }

  float row_weight(int row) const {
    const auto i = static_cast<std::size_t>(row);
    return i < figure_.row_heights.size() && figure_.row_heights[i] > 0
               ? static_cast<float>(figure_.row_heights[i])
               : 1.0F;
  }

  // Rows and columns: margins are common to a row or column, so that axes line
  // up; plots share what is left.
  void arrange() {
    const int columns = std::max(1, figure_.columns);
    const auto n = [](int i) { return static_cast<std::size_t>(i); };
    std::vector<float> left(n(columns)), right(n(columns)), top(n(rows_)), bottom(n(rows_));
    for (const PanelPlan& p : plan_.panels) {
      const std::size_t first = n(p.column), last = n(p.column + p.panel.column_span - 1), row = n(p.row);
      left[first] = std::max(left[first], p.margins.left);
      right[last] = std::max(right[last], p.margins.right);
      top[row] = std::max(top[row], p.margins.top);
      bottom[row] = std::max(bottom[row], p.margins.bottom);
    }
    const float edge = kEdge * plan_.pt, gap = kGap * plan_.pt;
    const auto sum = [](const std::vector<float>& v) {
      float total = 0;
      for (const float x : v) total += x;
      return total;
    };
    float title = 0;
    if (!plan_.title_lines.empty())
      title += static_cast<float>(plan_.title_lines.size()) * line_height(kTitleText * plan_.text_pt) +
               2 * plan_.pt;
    if (!plan_.subtitle_lines.empty())
      title += static_cast<float>(plan_.subtitle_lines.size()) * line_height(kSubtitleText * plan_.text_pt) +
               2 * plan_.pt;
    if (title > 0) title += 2 * plan_.pt;
    const float smallest = 4 * plan_.pt;  // a plot never vanishes, whatever its labels want
    const float width = std::max(smallest, (static_cast<float>(plan_.width_px) - 2 * edge -
                                            static_cast<float>(columns - 1) * gap - sum(left) - sum(right)) /
                                               static_cast<float>(columns));
    float weights = 0;
    for (int r = 0; r < rows_; ++r) weights += row_weight(r);
    const float height = std::max(smallest, static_cast<float>(plan_.height_px) - 2 * edge - title -
                                                static_cast<float>(rows_ - 1) * gap - sum(top) - sum(bottom));
    std::vector<float> x0(n(columns)), y0(n(rows_)), y1(n(rows_));
    float at = edge;
    for (std::size_t c = 0; c < x0.size(); ++c) {
      x0[c] = at + left[c];
      at = x0[c] + width + right[c] + gap;
    }
    at = edge + title;
    for (int r = 0; r < rows_; ++r) {
      y0[n(r)] = at + top[n(r)];
      y1[n(r)] = y0[n(r)] + height * row_weight(r) / weights;
      at = y1[n(r)] + bottom[n(r)] + gap;
    }
    for (PanelPlan& p : plan_.panels) {
      const std::size_t last = n(p.column + p.panel.column_span - 1);
      p.title_bottom = y0[n(p.row)] - p.margins.top +
                       (p.panel.title.empty() ? 0 : line_height(kPanelTitleText * plan_.text_pt));
      p.plot = {std::round(x0[n(p.column)]), std::round(y0[n(p.row)]), std::round(x0[last] + width),
                std::round(y1[n(p.row)])};
      p.label_left = x0[n(p.column)] - left[n(p.column)];
      p.x.from_px = p.plot.left;
      p.x.to_px = p.plot.right;
      p.y.from_px = p.plot.bottom;
      p.y.to_px = p.plot.top;
      p.bar_bottom = p.plot.bottom;
      if (p.panel.equal_scales && !p.panel.polar) equalise(p);
    }
    for (PanelPlan& p : plan_.panels) {
      if (!shows_map_without_bar(p)) continue;
      for (PanelPlan& q : plan_.panels)
        if (q.heat != nullptr) q.bar_bottom = std::max(q.bar_bottom, p.plot.bottom);
    }
  }

  static bool shows_map_without_bar(const PanelPlan& p) {
    return p.heat == nullptr && std::ranges::any_of(p.panel.marks, [](const Mark& mark) {
             return std::holds_alternative<HeatMap>(mark);
           });
  }

  // Widens the shorter axis about its middle until a unit is equally long on
  // both.
  static void equalise(PanelPlan& p) {
    const double ux = (p.x.high - p.x.low) / static_cast<double>(p.plot.width()),
                 uy = (p.y.high - p.y.low) / static_cast<double>(p.plot.height());
    Mapping& axis = ux < uy ? p.x : p.y;
    const double grow = ux < uy ? uy / ux : ux / uy, middle = 0.5 * (axis.low + axis.high),
                 half = 0.5 * (axis.high - axis.low) * grow;
    axis.low = middle - half;
    axis.high = middle + half;
  }

  void measure(PanelPlan& p) {
    const float pt = plan_.pt, tpt = plan_.text_pt, tick = kTickText * tpt, label = kLabelText * tpt;
    Margins& m = p.margins;
    m = {};
    if (!p.panel.title.empty()) m.top += line_height(kPanelTitleText * tpt) + 2 * pt;
    p.legend.entries = legend_entries(p.panel, p.plot.width(), fonts_, tpt);
    const float strip = p.legend.outside ? legend_height_px(lines_outside(p), tpt) + 3 * pt : 0;
    if (p.panel.polar) {
      p.y_ticks = linear_ticks(p.y.low, p.y.high, 4);
      m.left = m.right = 26 * tpt;
      m.top += kRimText * tpt;
      m.bottom = kRimText * tpt + strip;
      return;
    }
    m.top += strip;
    p.x_ticks = ticks_of(p.panel.x, p.x, p.plot.width(), 24 * tpt, fonts_, tick, true);
    p.y_ticks = ticks_of(p.panel.y, p.y, p.plot.height(), 15 * tpt, fonts_, tick, false);
    if (!p.panel.x.categories.empty()) {
      fit_categories(p.x_ticks.major, p.plot.width() / static_cast<float>(p.x.high - p.x.low), fonts_, tick);
    }
    if (!p.panel.x.groups.empty()) thin_out(p.x_ticks.major, p.x, tick);
    if (!p.panel.y.categories.empty()) {
      const float most =
          0.4F * static_cast<float>(plan_.width_px) / static_cast<float>(std::max(1, figure_.columns));
      for (Tick& t : p.y_ticks.major) t.label = fitted(t.label, most, fonts_, tick);
    }
    m.left = (kTickLength + kTickGap) * pt + widest_label(p.y_ticks, fonts_, tick);
    if (!axis_text(p.panel.y, p.y_ticks).empty()) m.left += line_height(label) + 2 * pt;
    m.top = std::max(m.top, 0.5F * tick);
    m.bottom = 2 * pt;
    if (p.shows_x_labels) {
      m.bottom =
          (kTickLength + kTickGap) * pt + line_height(tick) * static_cast<float>(most_lines(p.x_ticks));
      if (!axis_text(p.panel.x, p.x_ticks).empty()) m.bottom += line_height(label) + 1 * pt;
      if (!p.x_ticks.major.empty() && p.panel.x.categories.empty() && p.panel.x.groups.empty()) {
        const Tick& last = p.x_ticks.major.back();
        m.right =
            std::max(0.0F, p.x(last.value) + 0.5F * label_width(last.label, fonts_, tick) - p.plot.right);
        const Tick& first = p.x_ticks.major.front();
        m.left =
            std::max(m.left, p.plot.left - p.x(first.value) + 0.5F * label_width(first.label, fonts_, tick));
      }
    }
    if (p.heat != nullptr) {
      const ColorScale scale = color_scale_of(*p.heat);
      const Axis axis{.label = p.heat->label, .unit = p.heat->unit, .scale = scale.mapping.scale};
      const float bar = std::max(p.plot.height(), p.bar_bottom - p.plot.top);
      const Ticks ticks = ticks_of(axis, scale.mapping, bar, 15 * tpt, fonts_, tick, false);
      m.right =
          (kColorBarGap + kColorBarWidth + kTickLength + kTickGap) * pt + widest_label(ticks, fonts_, tick);
      if (!axis_text(axis, ticks).empty()) m.right += line_height(label) + 2 * pt;
    }
  }

  // Names that would touch the one before are left out.
  void thin_out(std::vector<Tick>& ticks, const Mapping& x, float size_px) const {
    float taken_px = -1e9F;
    for (Tick& t : ticks) {
      const float half_px = 0.5F * fonts_.width_px(t.label, size_px);
      if (x(t.value) - half_px < taken_px)
        t.label.clear();
      else
        taken_px = x(t.value) + half_px + 0.4F * size_px;
    }
  }

  int lines_outside(const PanelPlan& p) const {
    const std::vector<LegendSpot> spots = flowed(p.legend.entries, p.plot.width(), fonts_, plan_.text_pt);
    return spots.empty() ? 0 : spots.back().line + 1;
  }

  void place_legends() {
    for (PanelPlan& p : plan_.panels) {
      if (p.legend.entries.empty()) continue;
      p.legend.outside = p.panel.legend == Legend::kAbove || p.panel.polar || !inside(p);
    }
  }

  bool inside(PanelPlan& p) {
    Occupancy nothing({}, 1, fonts_);
    const auto place =
        free_place(view_of(p, plan_, nothing, fonts_, figure_.theme), p.legend.entries, p.colors);
    if (!place) return false;
    p.legend.box = place->box;
    p.legend.columns = place->columns;
    return true;
  }

  void finish_legend(PanelPlan& p) {
    if (p.legend.entries.empty()) return;
    // A strip above another panel of the row may have moved this one.
    if (!p.legend.outside && inside(p)) return;
    if (!p.legend.outside) return;
    const float height = legend_height_px(lines_outside(p), plan_.text_pt), gap = 3 * plan_.pt;
    const float top = p.panel.polar ? p.plot.top + std::min(p.plot.width(), p.plot.height()) + gap +
                                          kRimText * plan_.text_pt
                                    : p.plot.top - gap - height;
    p.legend.box = {p.plot.left, top, p.plot.right, top + height};
  }

  const Figure& figure_;
  const FontBook& fonts_;
  FigurePlan plan_;
  int rows_ = 0;
};

}  // namespace

void pixel_size(const Figure& figure, int& width_px, int& height_px) {
  constexpr double kMost = 16384;
  const double w = figure.width_mm / 25.4 * figure.dots_per_inch,
               h = figure.height_mm / 25.4 * figure.dots_per_inch;
  if (!(w >= 1 && w <= kMost && h >= 1 && h <= kMost && figure.text_scale > 0))
    throw UserError("figure \"" + figure.title + "\": " + std::to_string(w) + " x " + std::to_string(h) +
                    " pixels asked for, 1 to 16384 a side expected");
  width_px = static_cast<int>(std::lround(w));
  height_px = static_cast<int>(std::lround(h));
}

FigurePlan planned(const Figure& figure, const FontBook& fonts) { return Planner(figure, fonts).run(); }

PanelView view_of(const PanelPlan& plan, const FigurePlan& figure, Painter& painter, const FontBook& fonts,
                  Theme theme) {
  return {plan.panel, painter, fonts, theme, figure.pt, figure.text_pt, plan.plot, plan.x, plan.y};
}

}  // namespace waverig::render
