#include "render/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace waverig::render {

const ThemeColors& theme_colors(Theme theme) {
  static constexpr ThemeColors kPrint = {rgb(0xFFFFFF), rgb(0xFFFFFF), rgb(0x1A1A1A), rgb(0x5F6368),
                                         rgb(0xE3E5E8)};
  static constexpr ThemeColors kDark = {rgb(0x14181D), rgb(0x1A1F26), rgb(0xE8EAED), rgb(0x9AA3AD),
                                        rgb(0x303842)};
  return theme == Theme::kPrint ? kPrint : kDark;
}

Color palette(Theme theme, int index) {
  static constexpr std::array<Color, kPaletteSize> kPrint = {rgb(0x0072B2), rgb(0xD55E00), rgb(0x009E73),
                                                             rgb(0xCC79A7), rgb(0xE69F00), rgb(0x56B4E9),
                                                             rgb(0x4D4D4D)};
  static constexpr std::array<Color, kPaletteSize> kDark = {rgb(0x4FB3F0), rgb(0xFF8A3D), rgb(0x2FD0A0),
                                                            rgb(0xF0A0CC), rgb(0xFFC247), rgb(0x9BD8FF),
                                                            rgb(0xC8CCD2)};
  const auto i = static_cast<std::size_t>(((index % kPaletteSize) + kPaletteSize) % kPaletteSize);
  return theme == Theme::kPrint ? kPrint[i] : kDark[i];
}

Color color_of(ColorMap map, double share) {
  static constexpr std::array<Color, 12> kCividis = {
      rgb(0x00204D), rgb(0x00306F), rgb(0x2A406C), rgb(0x48526B), rgb(0x5E626E), rgb(0x727374),
      rgb(0x878479), rgb(0x9E9677), rgb(0xB6A971), rgb(0xD0BE67), rgb(0xEAD357), rgb(0xFFEA46)};
  static constexpr std::array<Color, 5> kDiverging = {rgb(0x00527F), rgb(0x6FB0D6), rgb(0xF7F7F7),
                                                      rgb(0xF0A070), rgb(0xA34300)};
  const std::span<const Color> stops =
      map == ColorMap::kSequential ? std::span<const Color>(kCividis) : kDiverging;
  const double at =
      std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return mixed(stops[i], stops[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

Color ramp_color(Theme theme, double share) {
  const double low = theme == Theme::kPrint ? 0.05 : 0.3, high = theme == Theme::kPrint ? 0.85 : 1;
  return color_of(ColorMap::kSequential, low + (high - low) * share);
}

float luminance(Color color) {
  const auto linear = [](float c) {
    return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
  };
  return 0.2126F * linear(color.r) + 0.7152F * linear(color.g) + 0.0722F * linear(color.b);
}

}  // namespace waverig::render
