#include "render/figure_writer.h"

#include "render/layout.h"
#include "render/svg_painter.h"

namespace waverig::render {

const Image& draw(const Figure& figure, Canvas& canvas) {
  int width_px = 0, height_px = 0;
  pixel_size(figure, width_px, height_px);
  prepare_fonts(figure, canvas.fonts());
  return canvas.draw(width_px, height_px, theme_colors(figure.theme).background,
                     [&](Painter& painter) { paint(figure, painter, canvas.fonts()); });
}

std::vector<std::pair<std::string, std::string>> embedded_text(const std::string& title,
                                                               const Provenance& provenance) {
  std::vector<std::pair<std::string, std::string>> text;
  if (!title.empty()) text.emplace_back("Title", title);
  if (!provenance.version.empty()) text.emplace_back("Software", "waverig " + provenance.version);
  if (!provenance.seed.empty()) text.emplace_back("Seed", provenance.seed);
  if (!provenance.command.empty()) text.emplace_back("Command", provenance.command);
  return text;
}

const std::vector<std::uint8_t>& png_bytes(const Figure& figure, Canvas& canvas,
                                           const Provenance& provenance) {
  return canvas.png().encode(draw(figure, canvas), {.dots_per_inch = figure.dots_per_inch,
                                                    .text = embedded_text(figure.title, provenance)});
}

void save_png(const Figure& figure, Canvas& canvas, const std::filesystem::path& path,
              const Provenance& provenance) {
  const std::vector<std::uint8_t>& bytes = png_bytes(figure, canvas, provenance);
  write_file(path, bytes.data(), bytes.size());
}

std::string svg_text(const Figure& figure, FontBook& fonts, const Provenance& provenance) {
  int width_px = 0, height_px = 0;
  pixel_size(figure, width_px, height_px);
  prepare_fonts(figure, fonts);
  fonts.bake();
  SvgPainter painter(width_px, height_px, figure.width_mm, theme_colors(figure.theme).background,
                     figure.title + "; waverig " + provenance.version + "; seed " + provenance.seed + "; " +
                         provenance.command);
  paint(figure, painter, fonts);
  return std::move(painter).finish();
}

void save_svg(const Figure& figure, FontBook& fonts, const std::filesystem::path& path,
              const Provenance& provenance) {
  const std::string text = svg_text(figure, fonts, provenance);
  write_file(path, text.data(), text.size());
}

}  // namespace waverig::render
