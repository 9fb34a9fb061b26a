// PanelView: one panel being drawn: where its axes lie on the page and how data
// become pixels.
#pragma once
#include <cmath>
#include <numbers>

#include "render/figure.h"
#include "render/font_book.h"
#include "render/painter.h"

namespace waverig::render {

// What an axis spans, and where on the page.
struct Mapping {
  Scale scale = Scale::kLinear;
  double low = 0, high = 1;
  float from_px = 0, to_px = 1;
  double knee = 1;  // of kSignedLog

  // 0 at low, 1 at high; NaN where a logarithm has no value.
  double share(double value) const {
    if (scale == Scale::kSignedLog)
      return (std::asinh(value / knee) - std::asinh(low / knee)) /
             (std::asinh(high / knee) - std::asinh(low / knee));
    if (scale != Scale::kLog) return (value - low) / (high - low);
    return value > 0 ? std::log(value / low) / std::log(high / low) : kAuto;
  }
  float operator()(double value) const {
    return from_px + static_cast<float>(share(value) * static_cast<double>(to_px - from_px));
  }
  double value_at(double share_of_axis) const {
    return scale == Scale::kLog ? low * std::pow(high / low, share_of_axis)
                                : low + (high - low) * share_of_axis;
  }
};

struct PanelView {
  const Panel& panel;
  Painter& painter;
  const FontBook& fonts;
  Theme theme;
  float pt;       // pixels of a typographic point
  float text_pt;  // pixels of a point of text
  Rect plot;
  Mapping x, y;

  const ThemeColors& colors() const { return theme_colors(theme); }
  float tick_text_px() const { return 7.5F * text_pt; }

  // A rose stands under its title.
  Vec2 centre() const {
    return {0.5F * (plot.left + plot.right),
            panel.polar ? plot.top + radius_px() : 0.5F * (plot.top + plot.bottom)};
  }
  float radius_px() const { return 0.5F * std::min(plot.width(), plot.height()); }
  // Polar: angle clockwise from the top.
  Vec2 polar_at(double angle_rad, float distance_px) const {
    return {centre().x + distance_px * static_cast<float>(std::sin(angle_rad)),
            centre().y - distance_px * static_cast<float>(std::cos(angle_rad))};
  }
  Vec2 at(double x_value, double y_value) const {
    if (!panel.polar) return {x(x_value), y(y_value)};
    return polar_at(x_value, static_cast<float>(y.share(y_value)) * radius_px());
  }
};

// Text sizes in points.
inline constexpr float kTickText = 7.5F, kLabelText = 8.5F, kPanelTitleText = 9.0F, kTitleText = 11.0F,
                       kSubtitleText = 8.5F, kNoteText = 7.5F, kSmallText = 6.0F;

}  // namespace waverig::render
