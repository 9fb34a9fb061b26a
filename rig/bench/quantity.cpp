#include "rig/bench/quantity.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

const std::map<std::string, std::pair<std::string, double>, std::less<>>& whole_units() {
  static const std::map<std::string, std::pair<std::string, double>, std::less<>> units = {
      {"1", {"1", 1}},    {"%", {"1", 1e-2}},        {"ppm", {"1", 1e-6}},
      {"min", {"s", 60}}, {"h", {"s", 3600}},        {"degC", {"degC", 1}},
      {"K", {"degC", 1}}, {"degC/s", {"degC/s", 1}}, {"degC/min", {"degC/s", 1.0 / 60}}};
  return units;
}

double prefix_factor(std::string_view prefix) {
  if (prefix.empty()) return 1;
  if (prefix == "n") return 1e-9;
  if (prefix == "u" || prefix == "µ") return 1e-6;
  if (prefix == "m") return 1e-3;
  if (prefix == "k") return 1e3;
  if (prefix == "M") return 1e6;
  return 0;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

Unit parse_unit(std::string_view text, const std::string& where) {
  if (const auto found = whole_units().find(text); found != whole_units().end())
    return {std::string(text), found->second.first, found->second.second};
  for (const std::string_view base : {"Hz", "A", "V", "C", "s"})
    if (text.ends_with(base))
      if (const double factor = prefix_factor(text.substr(0, text.size() - base.size())); factor > 0)
        return {std::string(text), std::string(base), factor};
  throw UserError(fmt::format(
      "{}: unit \"{}\": expected A, V, C, Hz or s with n, u, m, k or M, or min, h, degC, degC/min, "
      "%, ppm",
      where, text));
}

Quantity parse_quantity(std::string_view text, std::string_view base, const std::string& where) {
  const std::string_view body = trimmed(text);
  double number = 0;
  const char* begin = body.data() + (body.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, body.data() + body.size(), number);
  if (error != std::errc() || !std::isfinite(number))
    throw UserError(fmt::format("{}: \"{}\": expected a number with a unit of {}", where, text, base));
  const std::string_view unit = trimmed(body.substr(static_cast<std::size_t>(end - body.data())));
  const Unit parsed = parse_unit(unit.empty() ? "1" : unit, where);
  if (parsed.base != base)
    throw UserError(fmt::format("{}: \"{}\": expected a number with a unit of {}", where, text, base));
  return {number * parsed.factor, parsed};
}

std::string show_quantity(double si, std::string_view base) {
  static constexpr std::array<std::pair<const char*, double>, 6> kPrefixes = {
      {{"M", 1e6}, {"k", 1e3}, {"", 1}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}}};
  if (base == "1") return fmt::format("{:g}", si);
  if (base == "degC" || base == "degC/s" || si == 0) return fmt::format("{:g} {}", si, base);
  for (const auto& [prefix, factor] : kPrefixes)
    if (std::abs(si) >= 0.9999999 * factor) return fmt::format("{:.6g} {}{}", si / factor, prefix, base);
  return fmt::format("{:.6g} n{}", si / 1e-9, base);
}

std::string show_duration(double seconds) {
  const auto whole = std::llround(seconds);
  if (seconds < 60) return fmt::format("{:.3g} s", seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace waverig::rig::bench
