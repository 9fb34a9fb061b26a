// JSON as a person reads it: indented, a list of plain values on one line.
#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace waverig::estimator {

inline void append_readable(std::string& out, const nlohmann::ordered_json& j, std::size_t indent) {
  const bool plain = std::ranges::none_of(j, [](const auto& child) { return child.is_structured(); });
  if (!j.is_structured() || j.empty() || (j.is_array() && plain)) {
    out += j.dump();
    return;
  }
  const std::string margin(indent + 2, ' ');
  out += j.is_array() ? '[' : '{';
  bool first = true;
  for (const auto& [key, child] : j.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out += margin;
    if (j.is_object()) out += nlohmann::ordered_json(key).dump() + ": ";
    append_readable(out, child, indent + 2);
  }
  out += '\n' + margin.substr(2) + (j.is_array() ? ']' : '}');
}

inline std::string readable_json(const nlohmann::ordered_json& j) {
  std::string out;
  append_readable(out, j, 0);
  return out + '\n';
}

}  // namespace waverig::estimator
