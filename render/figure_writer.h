// Draws figures: onto a canvas, into PNG files, into SVG files.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/figure.h"
#include "render/png.h"

namespace waverig::render {

// The picture stays until the canvas draws the next. Throws UserError where the
// figure has no sensible size (1 to 16384 pixels a side).
const Image& draw(const Figure& figure, Canvas& canvas);

// What is embedded in a file, so that a picture found alone still tells where
// it comes from.
struct Provenance {
  std::string version{}, command{};
  std::string seed{};
};

// Text chunks of a PNG.
std::vector<std::pair<std::string, std::string>> embedded_text(const std::string& title,
                                                               const Provenance& provenance);

const std::vector<std::uint8_t>& png_bytes(const Figure& figure, Canvas& canvas,
                                           const Provenance& provenance);
void save_png(const Figure& figure, Canvas& canvas, const std::filesystem::path& path,
              const Provenance& provenance);

// The same figure as vectors. Text stays text, in DejaVu Sans.
std::string svg_text(const Figure& figure, FontBook& fonts, const Provenance& provenance);
void save_svg(const Figure& figure, FontBook& fonts, const std::filesystem::path& path,
              const Provenance& provenance);

// Draws a figure at its size on any painter whose fonts were prepared for it.
void prepare_fonts(const Figure& figure, FontBook& fonts);
void paint(const Figure& figure, Painter& painter, FontBook& fonts);

}  // namespace waverig::render
