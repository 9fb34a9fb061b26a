#include "render/axis.h"

#include <algorithm>
#include <cmath>

#include "render/text_fit.h"

namespace waverig::render {
namespace {

constexpr double kLargest = 1e300;  // keeps ranges finite

// Equal limits get a sensible width.
void give_width(double& low, double& high, bool log) {
  if (log && high < low * (1 + 1e-9)) {
    low /= 2;
    high *= 2;
  } else if (!log && high - low <= 1e-12 * std::max(std::abs(low), std::abs(high))) {
    const double half = low == 0 ? 0.5 : 0.05 * std::abs(low);
    low -= half;
    high += half;
  }
}

}  // namespace

void set_limits(const Axis& axis, const Extent& data, bool padded, bool on_base, Mapping& out) {
  out.scale = axis.scale;
  const bool log = axis.scale == Scale::kLog;
  const auto usable = [log](double v) { return std::isfinite(v) && (!log || v > 0); };
  Extent extent = data;
  if (axis.include_zero && !log) extent.add(0.0);
  double low = extent.low, high = extent.high;
  if (!axis.categories.empty() || !axis.groups.empty()) {
    std::size_t places = axis.categories.size();
    for (const AxisGroup& group : axis.groups) places += group.places;
    low = -0.5;
    high = static_cast<double>(places) - 0.5;
    padded = false;
  } else if (extent.empty()) {
    low = usable(axis.low)    ? axis.low
          : usable(axis.high) ? (log ? axis.high / 10 : axis.high - 1)
          : log               ? 0.1
                              : 0;
    high = low + (log ? 9 * low : 1);
    padded = false;
  }
  low = std::clamp(low, -kLargest, kLargest);
  high = std::clamp(high, -kLargest, kLargest);
  give_width(low, high, log);
  const double share = std::isfinite(axis.padding) ? axis.padding : padded ? 0.06 : 0;
  if (log) {
    const double factor = std::pow(high / low, share);
    low /= factor;
    high *= factor;
  } else {
    const double room = share * (high - low);
    on_base |= axis.include_zero;
    if (!(on_base && low == 0)) low -= room;
    if (!(on_base && high == 0)) high += room;
  }
  if (usable(axis.low)) low = axis.low;
  if (usable(axis.high)) high = axis.high;
  if (low > high) std::swap(low, high);
  give_width(low, high, log);
  out.low = low;
  out.high = high;
}

Ticks ticks_of(const Axis& axis, const Mapping& mapping, float length_px, float label_px,
               const FontBook& fonts, float size_px, bool along) {
  Ticks ticks;
  if (!axis.categories.empty()) {
    for (std::size_t i = 0; i < axis.categories.size(); ++i) {
      const double at = static_cast<double>(i);
      if (at >= mapping.low && at <= mapping.high) ticks.major.push_back({at, axis.categories[i]});
    }
    return ticks;
  }
  if (!axis.groups.empty()) {
    double from = -0.5;
    for (const AxisGroup& group : axis.groups) {
      const double to = from + static_cast<double>(group.places);
      ticks.major.push_back({0.5 * (from + to), group.name});
      ticks.parting.push_back(from = to);
    }
    ticks.parting.pop_back();
    return ticks;
  }
  const auto make = [&](int most) {
    switch (mapping.scale) {
      case Scale::kLog:
        return log_ticks(mapping.low, mapping.high, most);
      case Scale::kTime:
        return time_ticks(mapping.low, mapping.high, most);
      case Scale::kSignedLog:
        return signed_log_ticks(mapping.low, mapping.high, mapping.knee, most);
      case Scale::kLinear:
        break;
    }
    return linear_ticks(mapping.low, mapping.high, most);
  };
  int most = std::clamp(static_cast<int>(length_px / label_px), 2, 12);
  for (;; --most) {
    ticks = make(most);
    float widest = size_px;
    if (along)
      for (const Tick& t : ticks.major)
        widest =
            std::max(widest, fonts.width_px(t.label.substr(0, t.label.find('\n')), size_px) + 1.2F * size_px);
    if (most <= 2 || widest * static_cast<float>(ticks.major.size()) <= length_px * 1.05F) break;
  }
  if (axis.whole_numbers) {
    std::erase_if(ticks.major, [](const Tick& t) { return std::abs(t.value - std::round(t.value)) > 1e-9; });
    for (Tick& t : ticks.major) t.label = number_text(t.value, 0);
    ticks.minor.clear();
  }
  return ticks;
}

std::string axis_text(const Axis& axis, const Ticks& ticks) {
  std::string inside = ticks.suffix;
  if (!axis.unit.empty()) inside += (inside.empty() ? "" : " ") + axis.unit;
  if (inside.empty()) return axis.label;
  return (axis.label.empty() ? "" : axis.label + " ") + "(" + inside + ")";
}

std::string axis_text_fitted(const Axis& axis, const Ticks& ticks, float most_px, const FontBook& fonts,
                             float size_px) {
  const std::string whole = axis_text(axis, ticks);
  if (fonts.width_px(whole, size_px) <= most_px) return whole;
  const std::string unit = axis_text({.unit = axis.unit}, ticks);
  const float left_px = most_px - fonts.width_px(" " + unit, size_px);
  if (axis.label.empty() || left_px < 3 * size_px) return fitted(whole, most_px, fonts, size_px);
  return fitted(axis.label, left_px, fonts, size_px) + " " + unit;
}

}  // namespace waverig::render
