#include "render/legend.h"

#include <algorithm>
#include <array>

#include "render/layout.h"
#include "render/occupancy.h"

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
    if (name_of(panel.marks[i]).empty()) continue;
    const std::string name =
        fitted(name_of(panel.marks[i]), most_px - (kSwatch + kSwatchGap + 2 * kPadding) * text_pt, fonts,
               kText * text_pt);
    const auto same =
        std::find_if(entries.begin(), entries.end(), [&](const LegendEntry& e) { return e.name == name; });
    if (same != entries.end())
      same->marks.push_back(i);
    else
      entries.push_back({name, {i}});
  }
  return entries;
}

int legend_columns(const std::vector<LegendEntry>& entries, float width_px, const FontBook& fonts,
                   float text_pt) {
  int columns = std::max(1, static_cast<int>(entries.size()));
  while (columns > 1 && total_width(entries, columns, fonts, text_pt) > width_px) --columns;
  return columns;
}

float legend_height_px(std::size_t entries, int columns, float text_pt) {
  const auto rows = (entries + static_cast<std::size_t>(columns) - 1) / static_cast<std::size_t>(columns);
  return static_cast<float>(rows) * kPitch * text_pt;
}

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
    const float height = legend_height_px(entries.size(), columns, view.text_pt) + kPadding * view.text_pt;
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
  if (!legend.above) view.painter.fill_rect(legend.box, with_alpha(view.colors().panel, 0.85F));
  const float pad = legend.above ? 0 : kPadding * pt;
  const std::vector<float> widths = column_widths(legend.entries, legend.columns, view.fonts, pt);
  for (std::size_t i = 0; i < legend.entries.size(); ++i) {
    const std::size_t column = i % widths.size(), row = i / widths.size();
    float x = legend.box.left + pad;
    for (std::size_t c = 0; c < column; ++c) x += widths[c] + kColumnGap * pt;
    const float middle = legend.box.top + 0.5F * pad + (static_cast<float>(row) + 0.5F) * kPitch * pt;
    const float half = 0.36F * kPitch * pt;
    for (const std::size_t mark : legend.entries[i].marks)
      draw_swatch(view.panel.marks[mark], colors[mark], view,
                  {x, middle - half, x + kSwatch * pt, middle + half});
    view.painter.text({x + (kSwatch + kSwatchGap) * pt, middle}, legend.entries[i].name,
                      {.size_px = kText * pt, .color = view.colors().ink, .v = VAlign::kMiddle});
  }
}

}  // namespace waverig::render
