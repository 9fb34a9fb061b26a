#pragma once
#include <string>
#include <variant>

#include "render/figure.h"

namespace waverig::render {

// Of a panel's line with that name; null where it has none.
inline const Line* line_of(const Panel& panel, const std::string& name) {
  for (const Mark& mark : panel.marks) {
    if (const auto* line = std::get_if<Line>(&mark); line != nullptr && line->name == name) return line;
  }
  return nullptr;
}

}  // namespace waverig::render
