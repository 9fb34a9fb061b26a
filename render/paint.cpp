// Draws a planned figure, from the background to the labels.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/axis.h"
#include "render/figure_writer.h"
#include "render/layout.h"
#include "render/stroke.h"
#include "render/text_fit.h"

namespace waverig::render {
namespace {

constexpr float kTickLength = 3, kTickGap = 2.5F, kColorBarGap = 7,
                kColorBarWidth = 9;  // points

void line(const PanelView& v, Vec2 a, Vec2 b, Color color, float width_pt) {
  v.painter.stroke(std::array{a, b}, color, width_pt * v.pt);
}

// Hairlines lie on whole pixels, or they would be grey and two wide.
float crisp(float px) { return std::floor(px) + 0.5F; }

void draw_lines_of_text(Painter& painter, Vec2 at, const std::string& text, float pitch_px,
                        const TextStyle& style) {
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    painter.text(at, std::string_view(text).substr(from, to - from), style);
    at.y += pitch_px;
    from = to + 1;
  }
}

void draw_grid(const PanelPlan& p, const PanelView& v) {
  v.painter.fill_rect(p.plot, v.colors().panel);
  const float bottom = p.plot.bottom + (p.shows_x_labels ? 2 * kTickLength * v.pt : 0);
  for (const double at : p.x_ticks.parting)
    line(v, {crisp(p.x(at)), p.plot.top}, {crisp(p.x(at)), bottom},
         mixed(v.colors().grid, v.colors().faint_ink, 0.3F), 0.5F);
  for (const Tick& t : p.x_ticks.major) {
    if (p.panel.x.categories.empty() && p.panel.x.groups.empty())
      line(v, {crisp(p.x(t.value)), p.plot.top}, {crisp(p.x(t.value)), p.plot.bottom}, v.colors().grid, 0.5F);
  }
  for (const Tick& t : p.y_ticks.major) {
    if (p.panel.y.categories.empty())
      line(v, {p.plot.left, crisp(p.y(t.value))}, {p.plot.right, crisp(p.y(t.value))}, v.colors().grid, 0.5F);
  }
}

void draw_axes(const PanelPlan& p, const PanelView& v) {
  const Color ink = v.colors().ink;
  const float length = kTickLength * v.pt, tick_px = v.tick_text_px(), label_px = kLabelText * v.text_pt;
  const float left = crisp(p.plot.left), bottom = crisp(p.plot.bottom);
  line(v, {left, p.plot.top}, {left, bottom}, ink, 0.6F);
  line(v, {left, bottom}, {p.plot.right, bottom}, ink, 0.6F);
  for (const double minor : p.x_ticks.minor)
    line(v, {crisp(p.x(minor)), bottom}, {crisp(p.x(minor)), bottom + 0.5F * length}, ink, 0.4F);
  for (const double minor : p.y_ticks.minor)
    line(v, {left, crisp(p.y(minor))}, {left - 0.5F * length, crisp(p.y(minor))}, ink, 0.4F);
  for (const Tick& t : p.x_ticks.major) {
    const float x = crisp(p.x(t.value));
    if (p.panel.x.groups.empty()) line(v, {x, bottom}, {x, bottom + length}, ink, 0.6F);
    if (p.shows_x_labels)
      draw_lines_of_text(v.painter, {x, bottom + length + kTickGap * v.pt}, t.label, 1.3F * tick_px,
                         {.size_px = tick_px, .color = ink, .h = HAlign::kCenter, .v = VAlign::kTop});
  }
  for (const Tick& t : p.y_ticks.major) {
    const float y = crisp(p.y(t.value));
    line(v, {left, y}, {left - length, y}, ink, 0.6F);
    v.painter.text({left - length - kTickGap * v.pt, y}, t.label,
                   {.size_px = tick_px, .color = ink, .h = HAlign::kRight, .v = VAlign::kMiddle});
  }
  if (const std::string text = axis_text(p.panel.x, p.x_ticks); !text.empty() && p.shows_x_labels) {
    long rows = 1;
    for (const Tick& t : p.x_ticks.major)
      rows = std::max(rows, 1 + std::count(t.label.begin(), t.label.end(), '\n'));
    const float y =
        bottom + length + kTickGap * v.pt + 1.3F * tick_px * static_cast<float>(rows) + 1.5F * v.pt;
    v.painter.text({v.centre().x, y},
                   axis_text_fitted(p.panel.x, p.x_ticks, p.plot.width(), v.fonts, label_px),
                   {.size_px = label_px, .color = ink, .h = HAlign::kCenter, .v = VAlign::kTop});
  }
  if (const std::string text = axis_text(p.panel.y, p.y_ticks); !text.empty()) {
    const float x = p.label_left + 0.2F * label_px;
    // Left of title, legend and tick labels is room for the ends of a long one.
    const float most_px = p.plot.height() + 2 * std::min(p.margins.top, p.margins.bottom);
    v.painter.text(
        {x, v.centre().y}, axis_text_fitted(p.panel.y, p.y_ticks, most_px, v.fonts, label_px),
        {.size_px = label_px, .color = ink, .h = HAlign::kCenter, .v = VAlign::kTop, .upwards = true});
  }
}

void draw_polar_axes(const PanelPlan& p, const PanelView& v) {
  static constexpr std::array<const char*, 8> kPoints = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  const int rays = p.panel.compass ? 8 : 12;
  const Color ink = v.colors().ink, grid = mixed(v.colors().grid, v.colors().faint_ink, 0.3F);
  const float size = v.tick_text_px();
  for (int k = 0; k < rays; ++k) {
    const double angle = 2 * std::numbers::pi * k / rays;
    line(v, v.centre(), v.polar_at(angle, v.radius_px()), grid, 0.5F);
    const std::string text =
        p.panel.compass ? kPoints[static_cast<std::size_t>(k)] : std::to_string(30 * k) + "\u00B0";
    v.painter.text(v.polar_at(angle, v.radius_px() + 1.3F * size), text,
                   {.size_px = size, .color = ink, .h = HAlign::kCenter, .v = VAlign::kMiddle});
  }
  for (const Tick& t : p.y_ticks.major) {
    const float r = static_cast<float>(p.y.share(t.value)) * v.radius_px();
    if (r > 1) v.painter.stroke(arc(v.centre(), r, 0, 2 * std::numbers::pi), grid, 0.5F * v.pt);
  }
  v.painter.stroke(arc(v.centre(), v.radius_px(), 0, 2 * std::numbers::pi), ink, 0.6F * v.pt);
}

// Whether a sector of the panel's bars lies under a pixel.
bool on_sector(const PanelView& v, Vec2 pixel) {
  const double dx = static_cast<double>(pixel.x - v.centre().x),
               dy = static_cast<double>(v.centre().y - pixel.y);
  const double angle = std::atan2(dx, dy), share = std::hypot(dx, dy) / static_cast<double>(v.radius_px());
  for (const Mark& mark : v.panel.marks) {
    const auto* bars = std::get_if<Bars>(&mark);
    if (bars == nullptr) continue;
    for (std::size_t i = 0; i < std::min(bars->at.size(), bars->value.size()); ++i)
      if (std::abs(std::remainder(bars->at[i] - angle, 2 * std::numbers::pi)) < 0.5 * bars->width &&
          share < v.y.share(bars->value[i]))
        return true;
  }
  return false;
}

// Over the data, along one of the eight rays that compass and degree labels leave free: the one with the
// least data.
void draw_polar_radii(const PanelPlan& p, const PanelView& v) {
  constexpr int kHidden = 6;  // as a label with all six points on data
  struct Label {
    std::string text;
    float distance_px, half_px;
  };
  const float size = v.tick_text_px();
  std::vector<Label> labels;
  for (const Tick& t : p.y_ticks.major) {
    const float share = static_cast<float>(p.y.share(t.value));
    if (share < 0.1F) continue;
    const bool last = &t == &p.y_ticks.major.back();
    const std::string label = last && !p.panel.y.unit.empty() ? t.label + " " + p.panel.y.unit : t.label;
    labels.push_back({label, share * v.radius_px(), 0.5F * v.fonts.width_px(label, size) + 1.5F * v.pt});
  }
  const auto box_at = [&](const Label& label, double angle) {
    const Vec2 at = v.polar_at(angle, label.distance_px);
    return Rect{at.x - label.half_px, at.y - 0.6F * size, at.x + label.half_px, at.y + 0.6F * size};
  };
  double best = 0;
  int least = std::numeric_limits<int>::max();
  for (int k = 0; k < 8; ++k) {
    const double angle = (22.5 + 45 * k) * std::numbers::pi / 180;
    int covered = 0;
    Rect inner;  // the next ring's label, which flat rays bring near
    for (const Label& label : labels) {
      const Rect box = box_at(label, angle);
      const bool apart = inner.right <= box.left || box.right <= inner.left || inner.bottom <= box.top ||
                         box.bottom <= inner.top;
      if (!apart) covered += kHidden;
      inner = box;
      for (const float x : {box.left, 0.5F * (box.left + box.right), box.right})
        for (const float y : {box.top, box.bottom}) covered += on_sector(v, {x, y});
    }
    if (covered >= least) continue;
    least = covered;
    best = angle;
  }
  for (const Label& label : labels) {
    v.painter.fill_rect(box_at(label, best), with_alpha(v.colors().panel, 0.75F));
    v.painter.text(v.polar_at(best, label.distance_px), label.text,
                   {.size_px = size, .color = v.colors().ink, .h = HAlign::kCenter, .v = VAlign::kMiddle});
  }
}

void draw_color_bar(const PanelPlan& p, const PanelView& v) {
  const ColorScale scale = color_scale_of(*p.heat);
  const float left = std::round(p.plot.right + kColorBarGap * v.pt),
              right = std::round(left + kColorBarWidth * v.pt);
  const float top = p.plot.top, bottom = p.bar_bottom, height = bottom - top, tick_px = v.tick_text_px(),
              label_px = kLabelText * v.text_pt;
  for (float y = top; y < bottom; ++y)
    v.painter.fill_rect({left, y, right, y + 1}, color_of(scale.map, 1 - (y + 0.5F - top) / height));
  const std::array<Vec2, 5> frame = {
      {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}};
  v.painter.stroke(frame, v.colors().ink, 0.5F * v.pt);
  const Mapping& m = scale.mapping;
  const Ticks ticks = ticks_of({}, m, height, 15 * v.text_pt, v.fonts, tick_px, false);
  float widest = 0;
  for (const Tick& t : ticks.major) {
    const float y = crisp(bottom - static_cast<float>(m.share(t.value)) * height);
    line(v, {right, y}, {right + kTickLength * v.pt, y}, v.colors().ink, 0.6F);
    v.painter.text({right + (kTickLength + kTickGap) * v.pt, y}, t.label,
                   {.size_px = tick_px, .color = v.colors().ink, .v = VAlign::kMiddle});
    widest = std::max(widest, v.fonts.width_px(t.label, tick_px));
  }
  v.painter.text({right + (kTickLength + kTickGap + 3) * v.pt + widest, 0.5F * (top + bottom)},
                 axis_text_fitted({.label = p.heat->label, .unit = p.heat->unit}, ticks, 1.05F * height,
                                  v.fonts, label_px),
                 {.size_px = label_px,
                  .color = v.colors().ink,
                  .h = HAlign::kCenter,
                  .v = VAlign::kTop,
                  .upwards = true});
}

void draw_panel(const PanelPlan& p, const PanelView& v) {
  if (p.panel.polar)
    draw_polar_axes(p, v);
  else
    draw_grid(p, v);
  if (!p.panel.polar) v.painter.push_clip(p.plot);
  for (std::size_t i = 0; i < p.panel.marks.size(); ++i) draw_mark(p.panel.marks[i], p.colors[i], v);
  if (!p.panel.polar) v.painter.pop_clip();
  if (!p.has_data) {
    const float half = 0.5F * v.fonts.width_px("no data", kLabelText * v.text_pt) + 4 * v.pt;
    v.painter.fill_rect(
        {v.centre().x - half, v.centre().y - 8 * v.pt, v.centre().x + half, v.centre().y + 8 * v.pt},
        v.colors().panel);
    v.painter.text(v.centre(), "no data",
                   {.size_px = kLabelText * v.text_pt,
                    .color = v.colors().faint_ink,
                    .h = HAlign::kCenter,
                    .v = VAlign::kMiddle});
  }
  if (p.panel.polar)
    draw_polar_radii(p, v);
  else
    draw_axes(p, v);
  if (p.heat != nullptr) draw_color_bar(p, v);
  draw_legend(p.legend, p.colors, v);
  if (!p.panel.title.empty()) {
    const float size = kPanelTitleText * v.text_pt;
    v.painter.text({p.plot.left, p.title_bottom - 0.35F * size},
                   fitted(p.panel.title, p.plot.width() + p.margins.right, v.fonts, size, true),
                   {.size_px = size, .color = v.colors().ink, .bold = true});
  }
}

}  // namespace

void prepare_fonts(const Figure& figure, FontBook& fonts) {
  const float pt = static_cast<float>(figure.dots_per_inch / 72 * figure.text_scale);
  for (const float size : {kTickText, kLabelText, kSubtitleText, kNoteText, kSmallText})
    fonts.require(size * pt, false);
  for (const float size : {kPanelTitleText, kTitleText}) fonts.require(size * pt, true);
  fonts.require(figure.title);
  fonts.require(figure.subtitle);
  for (const Panel& panel : figure.panels) {
    fonts.require(panel.title);
    for (const Axis* axis : {&panel.x, &panel.y}) {
      fonts.require(axis->label);
      fonts.require(axis->unit);
      for (const std::string& name : axis->categories) fonts.require(name);
      for (const AxisGroup& group : axis->groups) fonts.require(group.name);
    }
    for (const Mark& mark : panel.marks) {
      fonts.require(name_of(mark));
      if (const auto* note = std::get_if<Note>(&mark)) fonts.require(note->text);
      if (const auto* rule = std::get_if<Rule>(&mark)) fonts.require(rule->label);
      if (const auto* heat = std::get_if<HeatMap>(&mark)) {
        fonts.require(heat->label);
        fonts.require(heat->unit);
        for (const std::string& text : heat->signs) fonts.require(text);
      }
    }
  }
}

void paint(const Figure& figure, Painter& painter, FontBook& fonts) {
  const FigurePlan plan = planned(figure, fonts);
  const ThemeColors& colors = theme_colors(figure.theme);
  const float left = 6 * plan.pt;
  float y = 6 * plan.pt;
  const auto block = [&](const std::vector<std::string>& lines, float size, bool bold, Color color) {
    for (const std::string& text : lines) {
      painter.text({left, y}, text, {.size_px = size, .color = color, .v = VAlign::kTop, .bold = bold});
      y += 1.3F * size;
    }
    if (!lines.empty()) y += 2 * plan.pt;
  };
  block(plan.title_lines, kTitleText * plan.text_pt, true, colors.ink);
  block(plan.subtitle_lines, kSubtitleText * plan.text_pt, false, colors.faint_ink);
  for (const PanelPlan& p : plan.panels) draw_panel(p, view_of(p, plan, painter, fonts, figure.theme));
}

}  // namespace waverig::render
