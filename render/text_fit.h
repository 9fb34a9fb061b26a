// Text made to fit.
#pragma once
#include <string>
#include <vector>

#include "render/font_book.h"

namespace waverig::render {

// The text, or as much of it as fits before an ellipsis; of a single word its two ends.
std::string fitted(const std::string& text, float most_px, const FontBook& fonts, float size_px,
                   bool bold = false);
// Broken at spaces (and at '\n') into at most `lines_at_most`, the last one fitted.
std::vector<std::string> wrapped(const std::string& text, float most_px, int lines_at_most,
                                 const FontBook& fonts, float size_px, bool bold = false);

}  // namespace waverig::render
