#include "render/legend.h"

#include <algorithm>
#include <array>

#include "render/marks.h"
#include "render/occupancy.h"
#include "render/text_fit.h"

namespace waverig::render {
namespace {

constexpr float kText = 7.5F, kSwatch = 15, kSwatchGap = 4, kColumnGap = 10, kPitch = 10.5F,
                kPadding = 3;  // points

float entry_px(const LegendEntry& entry, const FontBook& fonts, float text_pt) {
  return (kSwatch + kSwatchGap) * text_pt + fonts.width_px(entry.name, kText * text_pt);
}

std::vector<float> column_widths(const std::vector<LegendEntry>& entries, int columns, const FontBook& fonts,
                                 float text_pt) {
  std::vector<float> widths(static_cast<std::size_t>(columns), 0.0F);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    float& width = widths[i % widths.size()];
    width = std::max(width, entry_px(entries[i], fonts, text_pt));
  }
  return widths;
}

float total_width(const std::vector<LegendEntry>& entries, int columns, const FontBook& fonts,
                  float text_pt) {
  float total = static_cast<float>(columns - 1) * kColumnGap * text_pt;
  for (const float width : column_widths(entries, columns, fonts, text_pt)) total += width;
  return total;
}

}  // namespace

std::vector<LegendEntry> legend_entries(const Panel& panel, float most_px, const FontBook& fonts,
                                        float text_pt) {
  std::vector<LegendEntry> entries;
  if (panel.legend == Legend::kNone) return entries;
  for (std::size_t i = 0; i < panel.marks.size(); ++i) {
    const Mark& mark = panel.marks[i];
    if (name_of(mark).empty()) continue;
    const bool line_or_shade = std::holds_alternative<Rule>(mark) || std::holds_alternative<Span>(mark);
    if (!line_or_shade && !extents_of(mark, panel.x.scale, panel.y.scale).has_data) continue;
    const std::string name = fitted(name_of(mark), most_px - (kSwatch + kSwatchGap + 2 * kPadding) * text_pt,
                                    fonts, kText * text_pt);
    // By the whole name: shortened ones may look alike.
    const auto same = std::find_if(entries.begin(), entries.end(), [&](const LegendEntry& e) {
      return name_of(panel.marks[e.marks.front()]) == name_of(mark);
    });
    if (same != entries.end())
      same->marks.push_back(i);
    else
      entries.push_back({name, {i}});
  }
  return entries;
}

std::vector<LegendSpot> flowed(const std::vector<LegendEntry>& entries, float width_px, const FontBook& fonts,
                               float text_pt) {
  std::vector<LegendSpot> spots;
  LegendSpot next;
  for (const LegendEntry& entry : entries) {
    const float width = entry_px(entry, fonts, text_pt);
    if (next.x_px > 0 && next.x_px + width > width_px) next = {0, next.line + 1};
    spots.push_back(next);
    next.x_px += width + kColumnGap * text_pt;
  }
  return spots;
}

float legend_height_px(int lines, float text_pt) { return static_cast<float>(lines) * kPitch * text_pt; }

std::optional<FreePlace> free_place(const PanelView& view, const std::vector<LegendEntry>& entries,
                                    const std::vector<Color>& colors) {
  Occupancy taken(view.plot, 3 * view.pt, view.fonts);
  const PanelView coarse{view.panel,   taken,     view.fonts, view.theme, view.pt,
                         view.text_pt, view.plot, view.x,     view.y};
  for (std::size_t i = 0; i < view.panel.marks.size(); ++i) {
    const Mark& mark = view.panel.marks[i];
    if (!std::holds_alternative<Span>(mark)) draw_mark(mark, colors[i], coarse);
  }
  const float inset = 4 * view.pt;
  const Rect room{view.plot.left + inset, view.plot.top + inset, view.plot.right - inset,
                  view.plot.bottom - inset};
  for (const int columns : {1, static_cast<int>(entries.size()), 2}) {
    if (columns > static_cast<int>(entries.size())) continue;
    const float width = total_width(entries, columns, view.fonts, view.text_pt) + 2 * kPadding * view.text_pt;
    const int lines = (static_cast<int>(entries.size()) + columns - 1) / columns;
    const float height = legend_height_px(lines, view.text_pt) + kPadding * view.text_pt;
    if (width > room.width() || height > room.height()) continue;
    // Corners first, then along the edges, then anywhere.
    constexpr std::array<std::array<float, 2>, 8> kFirst = {
        {{1, 0}, {0, 0}, {1, 1}, {0, 1}, {0.5F, 0}, {0.5F, 1}, {1, 0.5F}, {0, 0.5F}}};
    const auto box_at = [&](float u, float v) {
      const float left = room.left + u * (room.width() - width),
                  top = room.top + v * (room.height() - height);
      return Rect{left, top, left + width, top + height};
    };
    for (const auto& [u, v] : kFirst) {
      if (taken.taken(box_at(u, v)) == 0) return FreePlace{box_at(u, v), columns};
    }
    constexpr int kParts = 12;
    for (int i = 0; i <= kParts; ++i) {
      for (const bool vertical_edge : {false, true}) {
        for (const float side : {0.0F, 1.0F}) {
          const float along = static_cast<float>(i) / kParts;
          const Rect box = vertical_edge ? box_at(side, along) : box_at(along, side);
          if (taken.taken(box) == 0) return FreePlace{box, columns};
        }
      }
    }
  }
  return std::nullopt;
}

void draw_legend(const LegendPlan& legend, const std::vector<Color>& colors, const PanelView& view) {
  if (legend.entries.empty()) return;
  const float pt = view.text_pt;
  if (!legend.outside) view.painter.fill_rect(legend.box, with_alpha(view.colors().panel, 0.85F));
  const float pad = legend.outside ? 0 : kPadding * pt;
  const std::vector<float> widths = column_widths(legend.entries, legend.columns, view.fonts, pt);
  const std::vector<LegendSpot> line_by_line =
      legend.outside ? flowed(legend.entries, legend.box.width(), view.fonts, pt) : std::vector<LegendSpot>{};
  for (std::size_t i = 0; i < legend.entries.size(); ++i) {
    LegendSpot spot{pad, static_cast<int>(i / widths.size())};
    for (std::size_t c = 0; c < i % widths.size(); ++c) spot.x_px += widths[c] + kColumnGap * pt;
    if (legend.outside) spot = line_by_line[i];
    const float x = legend.box.left + spot.x_px;
    const float middle = legend.box.top + 0.5F * pad + (static_cast<float>(spot.line) + 0.5F) * kPitch * pt;
    const float half = 0.36F * kPitch * pt;
    for (const std::size_t mark : legend.entries[i].marks)
      draw_swatch(view.panel.marks[mark], colors[mark], view,
                  {x, middle - half, x + kSwatch * pt, middle + half});
    view.painter.text({x + (kSwatch + kSwatchGap) * pt, middle}, legend.entries[i].name,
                      {.size_px = kText * pt, .color = view.colors().ink, .v = VAlign::kMiddle});
  }
}

}  // namespace waverig::render
