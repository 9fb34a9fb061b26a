// Colours: palette, themes and colour maps that colour-blind readers can tell
// apart.
#pragma once
#include <cstddef>
#include <cstdint>

namespace waverig::render {

struct Color {
  float r = 0, g = 0, b = 0, a = 1;  // sRGB, 0 to 1
  bool operator==(const Color&) const = default;
};

constexpr Color rgb(std::uint32_t hex, float alpha = 1) {
  return {static_cast<float>((hex >> 16) & 255) / 255, static_cast<float>((hex >> 8) & 255) / 255,
          static_cast<float>(hex & 255) / 255, alpha};
}
inline Color with_alpha(Color color, float alpha) { return {color.r, color.g, color.b, alpha}; }
inline Color mixed(Color a, Color b, float share_of_b) {
  return {a.r + (b.r - a.r) * share_of_b, a.g + (b.g - a.g) * share_of_b, a.b + (b.b - a.b) * share_of_b,
          a.a + (b.a - a.a) * share_of_b};
}

enum class Theme { kPrint, kDark };

struct ThemeColors {
  Color background, panel, ink, faint_ink, grid;
};
const ThemeColors& theme_colors(Theme theme);

// Okabe & Ito (2008), reordered so that neighbours differ in lightness too;
// lightened on the dark theme.
Color palette(Theme theme, int index);
inline constexpr int kPaletteSize = 7;
// The number in the palette of what belongs to the body's axis x, y or z, in every figure.
constexpr int axis_color(std::size_t axis) { return static_cast<int>(axis); }

enum class ColorMap { kSequential, kDiverging };
// share 0 to 1. Sequential: cividis (Nunez et al. 2018). Diverging: blue to
// white to vermillion, 0.5 neutral.
Color color_of(ColorMap map, double share);
// The part of the sequential map that stands off from the theme's background: series that have an order.
Color ramp_color(Theme theme, double share);
// Relative luminance of WCAG 2; text on a colour is white below 0.35.
float luminance(Color color);

}  // namespace waverig::render
