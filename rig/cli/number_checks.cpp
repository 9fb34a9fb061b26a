#include "rig/cli/number_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace waverig::cli {
namespace {

template <class Number>
CLI::Validator check(const char* in_help, const char* expected, bool (*fits)(Number)) {
  const auto complaint = [expected, fits](std::string& text) {
    Number number{};
    if (CLI::detail::lexical_cast(text, number) && fits(number)) return std::string();
    return fmt::format("{}: expected {}", text, expected);
  };
  return {complaint, in_help};
}

}  // namespace

CLI::Validator not_negative() {
  return check<double>("NONNEGATIVE", "a number of 0 or more",
                       [](double x) { return x >= 0 && std::isfinite(x); });
}

CLI::Validator positive() {
  return check<double>("POSITIVE", "a number above 0", [](double x) { return x > 0 && std::isfinite(x); });
}

CLI::Validator finite() {
  return check<double>("", "a number", [](double x) { return std::isfinite(x); });
}

CLI::Validator between(double low, double high) {
  const auto complaint = [low, high](std::string& text) {
    double number{};
    if (CLI::detail::lexical_cast(text, number) && number >= low && number <= high) return std::string();
    return fmt::format("{}: expected a number from {:g} to {:g}", text, low, high);
  };
  return {complaint, fmt::format("in [{:g} - {:g}]", low, high)};
}

CLI::Validator seed() {
  return check<std::int64_t>("NONNEGATIVE", "a whole number from 0 to 9.2e18",
                             [](std::int64_t x) { return x >= 0 && x <= 9'200'000'000'000'000'000; });
}

}  // namespace waverig::cli
