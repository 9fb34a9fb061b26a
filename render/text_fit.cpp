#include "render/text_fit.h"

namespace waverig::render {

namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }  // a character of UTF-8

}  // namespace

std::string fitted(const std::string& text, float most_px, const FontBook& fonts, float size_px, bool bold) {
  if (fonts.width_px(text, size_px, bold) <= most_px) return text;
  // Names of a family differ at their ends: of a single word its middle is left out.
  const bool middle = text.find(' ') == std::string::npos;
  std::string head = text, tail;
  if (middle) {
    std::size_t half = text.size() / 2;
    while (half < text.size() && continues(text[half])) ++half;
    head = text.substr(0, half);
    tail = text.substr(half);
  }
  while (!head.empty() && fonts.width_px(head + "\u2026" + tail, size_px, bold) > most_px) {
    while (continues(head.back())) head.pop_back();
    head.pop_back();
    if (tail.empty()) continue;
    tail.erase(0, 1);
    while (!tail.empty() && continues(tail.front())) tail.erase(0, 1);
  }
  return head + "\u2026" + tail;
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
