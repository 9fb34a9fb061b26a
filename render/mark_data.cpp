#include "render/marks.h"

#include <algorithm>
#include <cmath>

namespace waverig::render {
namespace {

struct ExtentsOf {
  Scale xs, ys;
  MarkExtents out{};

  void add(double x, double y) {
    if (!fits(x, xs) || !fits(y, ys)) return;
    out.x.add(x);
    out.y.add(y);
    out.has_data = true;
  }
  void operator()(const Line& m) {
    for (std::size_t i = 0; i < std::min(m.x.size(), m.y.size()); ++i) add(m.x[i], m.y[i]);
    out.pad_x = m.look.marker != Marker::kNone;
  }
  void operator()(const Points& m) {
    for (std::size_t i = 0; i < std::min(m.x.size(), m.y.size()); ++i) add(m.x[i], m.y[i]);
    out.pad_x = true;
  }
  void operator()(const Bars& m) {
    for (std::size_t i = 0; i < std::min(m.at.size(), m.value.size()); ++i) {
      if (!std::isfinite(m.value[i])) continue;
      for (const double edge : {m.at[i] - m.width / 2, m.at[i] + m.width / 2}) {
        for (const double length : {base_of(m, i), m.value[i]})
          m.horizontal ? add(length, edge) : add(edge, length);
      }
    }
    out.pad_x = out.on_base = true;
  }
  void operator()(const ErrorBars& m) {
    const std::size_t n = std::min({m.x.size(), m.y.size(), m.minus.size(), m.plus.size()});
    for (std::size_t i = 0; i < n; ++i) {
      for (const double d : {-m.minus[i], 0.0, m.plus[i]})
        m.horizontal ? add(m.x[i] + d, m.y[i]) : add(m.x[i], m.y[i] + d);
    }
    out.pad_x = true;
  }
  void operator()(const Band& m) {
    for (std::size_t i = 0; i < std::min({m.x.size(), m.low.size(), m.high.size()}); ++i) {
      add(m.x[i], m.low[i]);
      add(m.x[i], m.high[i]);
    }
  }
  void operator()(const Histogram& m) { (*this)(bars_of(m)); }
  void operator()(const HeatMap& m) {
    for (const double x : m.x_edges) {
      for (const double y : m.y_edges) add(x, y);
    }
    out.pad_y = false;
  }
  void operator()(const Rule& m) {
    (m.vertical ? out.x : out.y).add(fits(m.at, m.vertical ? xs : ys) ? m.at : kAuto);
  }
  void operator()(const Span&) {}
  void operator()(const Note&) {}
};

int color_number(const Mark& mark) {
  return std::visit(
      [](const auto& m) -> int {
        if constexpr (requires { m.look; })
          return m.look.color;
        else if constexpr (requires { m.color; })
          return m.color;
        else
          return kInk;
      },
      mark);
}

double ramp_of(const Mark& mark) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.look; })
          return m.look.ramp;
        else
          return kAuto;
      },
      mark);
}

}  // namespace

MarkExtents extents_of(const Mark& mark, Scale x_scale, Scale y_scale) {
  ExtentsOf extents{x_scale, y_scale};
  std::visit(extents, mark);
  return extents.out;
}

Bars bars_of(const Histogram& histogram) {
  std::vector<double> values;
  for (const double v : histogram.values) {
    if (std::isfinite(v)) values.push_back(v);
  }
  Bars bars{.name = histogram.name, .look = histogram.look};
  if (values.empty()) return bars;
  std::sort(values.begin(), values.end());
  double low = values.front(), high = values.back();
  if (low == high) {
    const double half = low == 0 ? 0.5 : 0.05 * std::abs(low);
    low -= half;
    high += half;
  }
  constexpr int kMostBins = 200;
  int bins = histogram.bins;
  if (bins <= 0) {
    // Freedman & Diaconis (1981): width = 2 IQR n^(-1/3)
    const double iqr = values[values.size() * 3 / 4] - values[values.size() / 4];
    const double width = 2 * iqr / std::cbrt(static_cast<double>(values.size()));
    bins = width > 0 ? static_cast<int>(std::min<double>(kMostBins, std::ceil((high - low) / width))) : 10;
  }
  bins = std::clamp(bins, 1, kMostBins);
  bars.width = (high - low) / bins;
  bars.at.resize(static_cast<std::size_t>(bins));
  bars.value.assign(bars.at.size(), 0.0);
  for (std::size_t k = 0; k < bars.at.size(); ++k)
    bars.at[k] = low + (static_cast<double>(k) + 0.5) * bars.width;
  const double weight = histogram.density ? 1 / (static_cast<double>(values.size()) * bars.width) : 1;
  for (const double v : values) {
    const auto bin = std::min(static_cast<std::size_t>((v - low) / bars.width), bars.value.size() - 1);
    bars.value[bin] += weight;
  }
  return bars;
}

Mark resolved(const Mark& mark) {
  if (const auto* histogram = std::get_if<Histogram>(&mark)) return bars_of(*histogram);
  return mark;
}

std::vector<Color> colors_of(const std::vector<Mark>& marks, Theme theme) {
  std::vector<Color> colors;
  int next = 0;
  for (const Mark& mark : marks) {
    if (const double ramp = ramp_of(mark); std::isfinite(ramp)) {
      colors.push_back(ramp_color(theme, ramp));
      continue;
    }
    const int number = color_number(mark);
    colors.push_back(number == kInk         ? theme_colors(theme).ink
                     : number == kFaintInk  ? theme_colors(theme).faint_ink
                     : number == kNextColor ? palette(theme, next++)
                                            : palette(theme, number));
  }
  return colors;
}

const std::string& name_of(const Mark& mark) {
  static const std::string kNone;
  return std::visit(
      [](const auto& m) -> const std::string& {
        if constexpr (requires { m.name; })
          return m.name;
        else
          return kNone;
      },
      mark);
}

ColorScale color_scale_of(const HeatMap& heat) {
  Extent extent;
  for (const double v : heat.values) {
    if (!heat.log_colors || v > 0) extent.add(v);
  }
  if (extent.empty()) extent = {heat.log_colors ? 0.1 : 0, 1};
  if (heat.map == ColorMap::kDiverging && !heat.log_colors) {
    const double most = std::max(std::abs(extent.low), std::abs(extent.high));
    extent = {-most, most};
  }
  if (std::isfinite(heat.low)) extent.low = heat.low;
  if (std::isfinite(heat.high)) extent.high = heat.high;
  if (!(extent.low < extent.high)) {
    const double middle = extent.low;
    const double half = middle == 0 ? 1 : 0.1 * std::abs(middle);
    extent = {middle - half, middle + half};
  }
  Mapping mapping{heat.log_colors ? Scale::kLog : Scale::kLinear, extent.low, extent.high, 0, 1};
  if (heat.map == ColorMap::kDiverging && heat.knee > 0) {
    mapping.scale = Scale::kSignedLog;
    mapping.knee = heat.knee;
  }
  return {mapping, heat.map};
}

}  // namespace waverig::render
