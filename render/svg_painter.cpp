#include "render/svg_painter.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace waverig::render {
namespace {

std::string hex(Color c) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

std::string fill_of(Color c) {
  return c.a < 1 ? fmt::format("fill=\"{}\" fill-opacity=\"{:.3g}\"", hex(c), c.a)
                 : fmt::format("fill=\"{}\"", hex(c));
}

void put_points(std::string& out, std::span<const Vec2> points) {
  for (const Vec2 p : points) fmt::format_to(std::back_inserter(out), "{:.2f},{:.2f} ", p.x, p.y);
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

SvgPainter::SvgPainter(int width_px, int height_px, double width_mm, Color background,
                       const std::string& description) {
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "width=\"{:.2f}mm\" height=\"{:.2f}mm\" viewBox=\"0 0 {} "
      "{}\" "
      "font-family=\"DejaVu Sans, Verdana, sans-serif\" "
      "stroke-linejoin=\"round\">\n<desc>{}</desc>\n",
      width_mm, width_mm * height_px / width_px, width_px, height_px, xml_escaped(description));
  fill_rect({0, 0, static_cast<float>(width_px), static_cast<float>(height_px)}, background);
}

void SvgPainter::stroke(std::span<const Vec2> points, Color color, float width_px) {
  if (points.empty()) return;
  fmt::format_to(std::back_inserter(out_),
                 "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\"{} "
                 "points=\"",
                 hex(color), width_px, color.a < 1 ? fmt::format(" stroke-opacity=\"{:.3g}\"", color.a) : "");
  put_points(out_, points);
  out_ += "\"/>\n";
}

void SvgPainter::fill_convex(std::span<const Vec2> corners, Color color) {
  fmt::format_to(std::back_inserter(out_), "<polygon {} points=\"", fill_of(color));
  put_points(out_, corners);
  out_ += "\"/>\n";
}

void SvgPainter::fill_between(std::span<const Vec2> upper, std::span<const Vec2> lower, Color color) {
  if (upper.size() < 2) return;
  std::vector<Vec2> outline(upper.begin(), upper.end());
  outline.insert(outline.end(), lower.rbegin(), lower.rend());
  fill_convex(outline, color);
}

void SvgPainter::fill_rect(const Rect& r, Color color) {
  fmt::format_to(std::back_inserter(out_),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                 "height=\"{:.2f}\" {}/>\n",
                 r.left, r.top, r.width(), r.height(), fill_of(color));
}

void SvgPainter::text(Vec2 at, std::string_view utf8, const TextStyle& style) {
  const float cap = kCapHeight * style.size_px;
  const float down = style.v == VAlign::kBaseline ? 0 : style.v == VAlign::kMiddle ? 0.5F * cap : cap;
  const char* anchor = style.h == HAlign::kLeft ? "start" : style.h == HAlign::kCenter ? "middle" : "end";
  fmt::format_to(std::back_inserter(out_),
                 "<text transform=\"translate({:.2f} {:.2f}){}\" y=\"{:.2f}\" "
                 "font-size=\"{:.2f}\" "
                 "text-anchor=\"{}\"{} {}>{}</text>\n",
                 at.x, at.y, style.upwards ? " rotate(-90)" : "", down, style.size_px, anchor,
                 style.bold ? " font-weight=\"bold\"" : "", fill_of(style.color), xml_escaped(utf8));
}

void SvgPainter::push_clip(const Rect& r) {
  ++clips_;
  fmt::format_to(std::back_inserter(out_),
                 "<clipPath id=\"c{0}\"><rect x=\"{1:.2f}\" y=\"{2:.2f}\" "
                 "width=\"{3:.2f}\" "
                 "height=\"{4:.2f}\"/></clipPath>\n<g clip-path=\"url(#c{0})\">\n",
                 clips_, r.left, r.top, r.width(), r.height());
}

void SvgPainter::pop_clip() { out_ += "</g>\n"; }

std::string SvgPainter::finish() && { return std::move(out_) + "</svg>\n"; }

}  // namespace waverig::render
