#include "render/text_fit.h"

namespace waverig::render {

std::string fitted(const std::string& text, float most_px, const FontBook& fonts, float size_px, bool bold) {
  if (fonts.width_px(text, size_px, bold) <= most_px) return text;
  std::string shorter = text;
  while (!shorter.empty()) {
    do {  // one character, with its continuation bytes
      const bool continuation = (static_cast<unsigned char>(shorter.back()) & 0xC0U) == 0x80U;
      shorter.pop_back();
      if (!continuation) break;
    } while (!shorter.empty());
    if (fonts.width_px(shorter + "\u2026", size_px, bold) <= most_px) break;
  }
  return shorter + "\u2026";
}

std::vector<std::string> wrapped(const std::string& text, float most_px, int lines_at_most,
                                 const FontBook& fonts, float size_px, bool bold) {
  std::vector<std::string> lines;
  if (text.empty()) return lines;
  std::string line;
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t to = std::min(text.find_first_of(" \n", from), text.size());
    const std::string word = text.substr(from, to - from);
    const std::string longer = line.empty() ? word : line + " " + word;
    const bool last_line = static_cast<int>(lines.size()) + 1 >= lines_at_most;
    if (line.empty() || last_line || fonts.width_px(longer, size_px, bold) <= most_px) {
      line = longer;
    } else {
      lines.push_back(line);
      line = word;
    }
    if (to < text.size() && text[to] == '\n' && static_cast<int>(lines.size()) + 1 < lines_at_most) {
      lines.push_back(line);
      line.clear();
    }
    from = to + 1;
  }
  lines.push_back(line);
  for (std::string& l : lines) l = fitted(l, most_px, fonts, size_px, bold);
  return lines;
}

}  // namespace waverig::render
