// JSON as a person reads it: indented, a list of plain values on one line; and what a person got wrong in it.
#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

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

// The first key that an object has twice, of which a parser would take the one and drop the other; empty where
// there is none. Of text that is JSON.
inline std::string key_given_twice(const std::string& text) {
  using Event = nlohmann::json::parse_event_t;
  std::vector<std::set<std::string>> open;
  std::string twice;
  const auto note = [&](int, Event event, const nlohmann::json& parsed) {
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end) open.pop_back();
    if (event == Event::key && !open.back().insert(parsed.get<std::string>()).second && twice.empty())
      twice = parsed.get<std::string>();
    return true;
  };
  return nlohmann::json::parse(text, note, false).is_discarded() ? std::string() : twice;
}

}  // namespace waverig::estimator
