// Quantities as people write them, "500 uA", "0.1 degC/min", "38 h": a number and a unit, in SI inside.
#pragma once
#include <string>
#include <string_view>

namespace waverig::rig::bench {

struct Unit {
  std::string text;   // as written: "uA"
  std::string base;   // what it measures, as its SI unit: "A"; "1" for a bare number
  double factor = 1;  // SI = factor * number
};

struct Quantity {
  double si = 0;
  Unit unit;
};

// Both throw UserError, saying what was expected. where: file, line and key, for the sentence.
Unit parse_unit(std::string_view text, const std::string& where);
// base: the SI unit that is expected; a bare number is refused where it is not "1".
Quantity parse_quantity(std::string_view text, std::string_view base, const std::string& where);

// "500 uA" from 5e-4 and "A": a prefix that leaves 1 to 999 before it.
std::string show_quantity(double si, std::string_view base);
std::string show_duration(double seconds);  // "38 h 02 min", "4 min 10 s", "12.5 s"

}  // namespace waverig::rig::bench
