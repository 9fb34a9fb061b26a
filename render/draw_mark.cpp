#include <algorithm>
#include <array>
#include <cmath>

#include "render/decimate.h"
#include "render/marks.h"
#include "render/stroke.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

constexpr float kFarPx = 30000;  // beyond this a point is moved to the edge of what is exact in float

float near_page(float px) { return std::clamp(px, -kFarPx, kFarPx); }

// Points of a series in pixels, cut where a value is missing.
std::vector<std::vector<Vec2>> runs_of(const std::vector<double>& x, const std::vector<double>& y,
                                       const PanelView& view) {
  std::vector<std::vector<Vec2>> runs;
  bool open = false;
  const std::size_t n = std::min(x.size(), y.size());
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 p =
        fits(x[i], view.x.scale) && fits(y[i], view.y.scale) ? view.at(x[i], y[i]) : Vec2{NAN, NAN};
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      open = false;
      continue;
    }
    if (!open) runs.emplace_back().reserve(n - i);
    open = true;
    runs.back().push_back({near_page(p.x), near_page(p.y)});
  }
  return runs;
}

struct Draw {
  const PanelView& view;
  Color color;

  float width(const Look& look) const { return static_cast<float>(look.width_pt) * view.pt; }
  Color shade(const Look& look) const { return with_alpha(color, static_cast<float>(look.alpha)); }
  void markers(const std::vector<Vec2>& points, const Look& look) const {
    for (const Vec2 p : points) {
      if (p.x < view.plot.left - 50 || p.x > view.plot.right + 50 || p.y < view.plot.top - 50 ||
          p.y > view.plot.bottom + 50)
        continue;
      draw_marker(view.painter, p, look.marker, static_cast<float>(look.marker_pt) * view.pt, shade(look),
                  view.colors().panel);
    }
  }

  void operator()(const Line& m) const {
    for (std::vector<Vec2>& run : runs_of(m.x, m.y, view)) {
      if (m.look.marker != Marker::kNone) markers(run, m.look);
      stroke_dashed(view.painter, decimated(std::move(run)), shade(m.look), width(m.look), m.look.dash);
    }
  }
  // Of many points on one pixel one is enough where they cannot be told apart.
  void operator()(const Points& m) const {
    std::vector<Vec2> points;
    for (const std::vector<Vec2>& run : runs_of(m.x, m.y, view))
      points.insert(points.end(), run.begin(), run.end());
    constexpr std::size_t kMany = 20000;
    if (points.size() > kMany) {
      const auto cell = [](Vec2 p) { return std::pair(std::lround(p.y), std::lround(p.x)); };
      std::stable_sort(points.begin(), points.end(), [&](Vec2 a, Vec2 b) { return cell(a) < cell(b); });
      points.erase(
          std::unique(points.begin(), points.end(), [&](Vec2 a, Vec2 b) { return cell(a) == cell(b); }),
          points.end());
    }
    markers(points, m.look);
  }
  void operator()(const Bars& m) const {
    for (std::size_t i = 0; i < std::min(m.at.size(), m.value.size()); ++i) {
      if (!std::isfinite(m.at[i]) || !std::isfinite(m.value[i])) continue;
      const double from = m.at[i] - m.width / 2, to = m.at[i] + m.width / 2;
      if (view.panel.polar) {
        wedge(from, to, base_of(m, i), m.value[i], m.look);
        continue;
      }
      const Mapping& lengths = m.horizontal ? view.x : view.y;
      const double base = lengths.scale == Scale::kLog && base_of(m, i) <= 0 ? lengths.low : base_of(m, i);
      const auto corner = [&](double at, double length) {
        return m.horizontal ? view.at(length, at) : view.at(at, length);
      };
      const Vec2 a = corner(from, base), b = corner(to, m.value[i]);
      view.painter.fill_rect(
          {near_page(std::round(std::min(a.x, b.x))), near_page(std::round(std::min(a.y, b.y))),
           near_page(std::round(std::max(a.x, b.x))), near_page(std::round(std::max(a.y, b.y)))},
          shade(m.look));
    }
  }
  void wedge(double from, double to, double base, double value, const Look& look) const {
    const auto distance = [&](double v) {
      return std::max(0.0F, static_cast<float>(view.y.share(v)) * view.radius_px());
    };
    const std::vector<Vec2> outer = arc(view.centre(), distance(value), from, to);
    std::vector<Vec2> inner;
    for (std::size_t k = 0; k < outer.size(); ++k) {
      inner.push_back(
          view.polar_at(from + (to - from) * static_cast<double>(k) / static_cast<double>(outer.size() - 1),
                        distance(base)));
    }
    view.painter.fill_between(outer, inner, shade(look));
    std::vector<Vec2> outline = outer;
    outline.insert(outline.end(), inner.rbegin(), inner.rend());
    outline.push_back(outer.front());
    view.painter.stroke(outline, view.colors().panel, 0.6F * view.pt);
  }
  void operator()(const ErrorBars& m) const {
    const std::size_t n = std::min({m.x.size(), m.y.size(), m.minus.size(), m.plus.size()});
    const float cap = static_cast<float>(m.look.marker_pt) * 0.5F * view.pt;
    for (std::size_t i = 0; i < n; ++i) {
      const auto end = [&](double d) {
        return m.horizontal ? view.at(m.x[i] + d, m.y[i]) : view.at(m.x[i], m.y[i] + d);
      };
      Vec2 a = end(-m.minus[i]), b = end(m.plus[i]);
      if (!m.horizontal && std::isnan(a.y)) a = {b.x, view.plot.bottom + 10};  // below a logarithmic axis
      if (!std::isfinite(a.x + a.y + b.x + b.y)) continue;
      a = {near_page(a.x), near_page(a.y)};
      b = {near_page(b.x), near_page(b.y)};
      const Vec2 across = m.horizontal ? Vec2{0, cap} : Vec2{cap, 0};
      const auto line = [&](Vec2 p, Vec2 q) {
        view.painter.stroke(std::array{p, q}, shade(m.look), width(m.look));
      };
      line(a, b);
      if (cap <= 0) continue;
      line({a.x - across.x, a.y - across.y}, {a.x + across.x, a.y + across.y});
      line({b.x - across.x, b.y - across.y}, {b.x + across.x, b.y + across.y});
    }
  }
  void operator()(const Band& m) const {
    std::vector<Vec2> upper, lower;
    const auto flush = [&] {
      view.painter.fill_between(upper, lower, shade(m.look));
      upper.clear();
      lower.clear();
    };
    for (std::size_t i = 0; i < std::min({m.x.size(), m.low.size(), m.high.size()}); ++i) {
      double low = m.low[i];
      if (view.y.scale == Scale::kLog && low <= 0) low = view.y.low * 1e-3;
      const Vec2 a = view.at(m.x[i], m.high[i]), b = view.at(m.x[i], low);
      if (!std::isfinite(a.x + a.y + b.y)) {
        flush();
        continue;
      }
      upper.push_back({near_page(a.x), near_page(a.y)});
      lower.push_back({near_page(b.x), near_page(b.y)});
    }
    flush();
  }
  void operator()(const Histogram& m) const { (*this)(bars_of(m)); }
  void operator()(const HeatMap& m) const {
    if (m.x_edges.size() < 2 || m.y_edges.size() < 2) return;
    const ColorScale scale = color_scale_of(m);
    const std::size_t columns = m.x_edges.size() - 1, rows = m.y_edges.size() - 1;
    const CellNumbers numbers = numbers_that_fit(m);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t i = r * columns + c;
        if (i >= m.values.size()) continue;
        const Vec2 a = view.at(m.x_edges[c], m.y_edges[r + 1]), b = view.at(m.x_edges[c + 1], m.y_edges[r]);
        const bool known = std::isfinite(m.values[i]);
        const Color fill = known ? scale.at(m.values[i]) : view.colors().panel;
        if (known)
          view.painter.fill_rect({std::round(a.x), std::round(a.y), std::round(b.x), std::round(b.y)}, fill);
        const std::string text = cell_text_of(m, i, numbers.decimals);
        if (!text.empty())
          cell_text(text, numbers.decimals >= 0 ? numbers.size_px : view.tick_text_px(), {a.x, a.y, b.x, b.y},
                    luminance(fill) < 0.18F ? rgb(0xFFFFFF) : rgb(0x1A1A1A));
      }
    }
  }
  static std::string cell_text_of(const HeatMap& m, std::size_t i, int decimals) {
    std::string text;
    if (decimals >= 0 && std::isfinite(m.values[i]))
      text = m.log_colors ? significant_text(m.values[i], decimals) : number_text(m.values[i], decimals);
    return i < m.signs.size() ? text + m.signs[i] : text;
  }
  struct CellNumbers {
    int decimals = -1;  // -1: none has room
    float size_px = 0;
  };
  // Every cell holds its number or none does: smaller text comes before fewer digits.
  CellNumbers numbers_that_fit(const HeatMap& m) const {
    float narrowest = view.plot.width();
    for (std::size_t c = 0; c + 1 < m.x_edges.size(); ++c)
      narrowest = std::min(narrowest, std::abs(view.x(m.x_edges[c + 1]) - view.x(m.x_edges[c])));
    const int fewest = std::min(m.decimals, m.log_colors ? 2 : 1);
    for (int decimals = m.decimals; decimals >= 0 && decimals >= fewest; --decimals) {
      for (const float size : {kTickText * view.text_pt, kSmallText * view.text_pt}) {
        float widest = 0;
        for (std::size_t i = 0; i < m.values.size(); ++i)
          widest = std::max(widest, view.fonts.width_px(cell_text_of(m, i, decimals), size));
        if (widest + 0.4F * size < narrowest) return {decimals, size};
      }
    }
    return {};
  }
  void cell_text(const std::string& text, float size, const Rect& cell, Color ink) const {
    if (view.fonts.width_px(text, size) >= cell.width() || 1.35F * size > cell.height()) return;
    view.painter.text({0.5F * (cell.left + cell.right), 0.5F * (cell.top + cell.bottom)}, text,
                      {.size_px = size, .color = ink, .h = HAlign::kCenter, .v = VAlign::kMiddle});
  }
  void operator()(const Rule& m) const {
    const float at = m.vertical ? view.x(m.at) : view.y(m.at);
    if (!std::isfinite(at) || view.panel.polar) return;
    const Rect& p = view.plot;
    const std::array<Vec2, 2> line = m.vertical ? std::array<Vec2, 2>{{{at, p.bottom}, {at, p.top}}}
                                                : std::array<Vec2, 2>{{{p.left, at}, {p.right, at}}};
    stroke_dashed(view.painter, line, shade(m.look), width(m.look), m.look.dash);
    if (m.label.empty()) return;
    const float gap = 2.5F * view.pt;
    const TextStyle style{.size_px = view.tick_text_px(),
                          .color = color,
                          .h = HAlign::kRight,
                          .v = m.vertical ? VAlign::kTop : VAlign::kBaseline,
                          .upwards = m.vertical};
    if (m.vertical)
      view.painter.text({at + gap, p.top + gap}, m.label, style);
    else
      view.painter.text({p.right - gap, at - gap}, m.label, style);
  }
  void operator()(const Span& m) const {
    const Rect& p = view.plot;
    const Mapping& axis = m.vertical ? view.x : view.y;
    const float a = axis(m.from), b = axis(m.to);
    if (!std::isfinite(a + b)) return;
    const float low = near_page(std::min(a, b)), high = near_page(std::max(a, b));
    view.painter.fill_rect(m.vertical ? Rect{low, p.top, high, p.bottom} : Rect{p.left, low, p.right, high},
                           shade(m.look));
  }
  void operator()(const Note& m) const {
    const Rect& p = view.plot;
    const Vec2 at = m.in_data ? view.at(m.x, m.y)
                              : Vec2{p.left + static_cast<float>(m.x) * p.width(),
                                     p.bottom - static_cast<float>(m.y) * p.height()};
    if (!std::isfinite(at.x + at.y)) return;
    std::vector<std::string> lines;
    for (std::size_t from = 0; from <= m.text.size();) {
      const std::size_t to = std::min(m.text.find('\n', from), m.text.size());
      lines.push_back(m.text.substr(from, to - from));
      from = to + 1;
    }
    const float size = kNoteText * view.text_pt, pitch = 1.35F * size;
    float width_px = 0;
    for (const std::string& line : lines) width_px = std::max(width_px, view.fonts.width_px(line, size));
    const float height_px = pitch * static_cast<float>(lines.size());
    // Kept inside the panel, whatever the place asked for.
    const float margin = 3 * view.pt;
    const float left =
        std::clamp(at.x, p.left + margin, std::max(p.left + margin, p.right - width_px - margin));
    const float top =
        std::clamp(at.y, p.top + margin, std::max(p.top + margin, p.bottom - height_px - margin));
    if (m.boxed)
      view.painter.fill_rect(
          {left - margin, top - margin, left + width_px + margin, top + height_px + 0.5F * margin},
          with_alpha(view.colors().panel, 0.85F));
    float y = top;
    for (const std::string& line : lines) {
      view.painter.text({left, y}, line, {.size_px = size, .color = color, .v = VAlign::kTop});
      y += pitch;
    }
  }
};

}  // namespace

void draw_mark(const Mark& mark, Color color, const PanelView& view) { std::visit(Draw{view, color}, mark); }

void draw_swatch(const Mark& mark, Color color, const PanelView& view, const Rect& place) {
  const float middle = 0.5F * (place.top + place.bottom);
  std::visit(
      [&](const auto& m) {
        using M = std::decay_t<decltype(m)>;
        if constexpr (requires { m.look; }) {
          const Color shade = with_alpha(color, static_cast<float>(m.look.alpha));
          if constexpr (std::is_same_v<M, Bars> || std::is_same_v<M, Band> || std::is_same_v<M, Span>) {
            const float half = 0.33F * place.height();
            view.painter.fill_rect(
                {place.left, std::round(middle - half), place.right, std::round(middle + half)}, shade);
          } else if constexpr (std::is_same_v<M, ErrorBars>) {
            const float x = 0.5F * (place.left + place.right), half = 0.45F * place.height();
            view.painter.stroke(std::array<Vec2, 2>{{{x, middle - half}, {x, middle + half}}}, shade,
                                static_cast<float>(m.look.width_pt) * view.pt);
          } else {
            if constexpr (!std::is_same_v<M, Points>)
              stroke_dashed(view.painter, std::array<Vec2, 2>{{{place.left, middle}, {place.right, middle}}},
                            shade, std::max(1.0F, static_cast<float>(m.look.width_pt)) * view.pt,
                            m.look.dash);
            draw_marker(view.painter, {0.5F * (place.left + place.right), middle}, m.look.marker,
                        std::min(static_cast<float>(m.look.marker_pt) * view.pt, place.height()),
                        with_alpha(color, std::max(0.6F, shade.a)), view.colors().panel);
          }
        }
      },
      mark);
}

}  // namespace waverig::render
