// Where an axis carries ticks and what stands there: round numbers, decades, or
// round times of day.
#pragma once
#include <string>
#include <vector>

namespace waverig::render {

struct Tick {
  double value = 0;
  std::string label;  // UTF-8, with a true minus sign
};

struct Ticks {
  std::vector<Tick> major;
  std::vector<double> minor;
  std::vector<double> parting;  // where one group ends and the next begins: the major ones are names alone
  std::string suffix;           // belongs to the axis label: "×10⁻⁶", "+ 12000000", a
                                // date; often empty
};

// Major ticks within [low, high], at most `most` (or 3 where that is less), at least one; low < high, both
// finite.
Ticks linear_ticks(double low, double high, int most);
Ticks log_ticks(double low, double high, int most);                      // low > 0
Ticks signed_log_ticks(double low, double high, double knee, int most);  // 0, and both signs from the knee on
Ticks time_ticks(double low, double high, int most);                     // seconds since 1970, UTC

// The largest step of 1, 2 or 5 times a power of ten with which [0, range]
// holds at most `most` steps.
double nice_step(double range, int most);

// A number for people: decimals as given, thin-minus replaced by U+2212, no
// negative zero.
std::string number_text(double value, int decimals);
// The same with at least so many significant digits.
std::string significant_text(double value, int digits);
// "10⁻³"
std::string power_of_ten_text(int exponent);

}  // namespace waverig::render
