#include "render/ticks.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

namespace waverig::render {
namespace {

constexpr double kSlack = 1e-9;  // of a step: a tick at the very end of an axis counts as on it

int decimals_of(double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - kSlack)), 0, 17);
}

template <class Function>
void for_each_multiple(double low, double high, double step, Function f) {
  constexpr double kMost = 1000;  // more are never wanted: the step is too small for its interval
  const double first = std::ceil(low / step - kSlack), count = std::floor(high / step + kSlack) - first;
  if (!(count >= 0 && count < kMost)) return;
  for (int k = 0; k <= static_cast<int>(count); ++k) f((first + k) * step);
}

}  // namespace

double nice_step(double range, int most) {
  const double wanted = range / std::max(1, most);
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= wanted * (1 - kSlack)) return factor * decade;
  }
  return 10 * decade;
}

std::string number_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.starts_with('-')) {
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    text.replace(0, 1, zero ? "" : "\u2212");
  }
  return text;
}

std::string significant_text(double value, int digits) {
  const double size = std::abs(value);
  return number_text(value,
                     size > 0 ? std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size)))) : 0);
}

std::string power_of_ten_text(int exponent) {
  static constexpr std::array<const char*, 10> kSuperscript = {
      "\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074", "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207B" : "10";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += kSuperscript[static_cast<std::size_t>(digit - '0')];
  return text;
}

Ticks linear_ticks(double low, double high, int most) {
  Ticks ticks;
  const double largest = std::max(std::abs(low), std::abs(high)), range = high - low;
  most = std::max(3, most);
  // The finest round step that fits: depending on where the interval lies, a finer one may fit than its
  // length tells.
  double step = nice_step(range, 2 * most);
  while (std::floor(high / step + kSlack) - std::ceil(low / step - kSlack) + 1 > most)
    step = nice_step(1.5 * step, 1);

  // A long common part goes to the axis label: a power of ten, or an offset
  // where only the last digits differ.
  double scale = 1, offset = 0;
  if (range < 1e-5 * largest) {
    offset = std::floor(low / (100 * step)) * 100 * step;
    ticks.suffix = (offset < 0 ? "\u2212 " : "+ ") + fmt::format("{:.12g}", std::abs(offset));
  } else if (largest >= 1e5 || largest < 1e-2) {
    const int exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
    scale = std::pow(10.0, exponent);
    ticks.suffix = "\u00D7" + power_of_ten_text(exponent);
  }
  const int decimals = decimals_of(step / scale);
  for_each_multiple(low, high, step, [&](double v) {
    ticks.major.push_back({v, number_text((v - offset) / scale, decimals)});
  });
  const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + kSlack));
  const int parts = mantissa > 1.5 && mantissa < 2.5 ? 4 : 5;
  for_each_multiple(low, high, step / parts, [&](double v) {
    const double of_major = v / step;
    if (std::abs(of_major - std::round(of_major)) > 0.5 / parts) ticks.minor.push_back(v);
  });
  return ticks;
}

Ticks log_ticks(double low, double high, int most) {
  Ticks ticks;
  const double first = std::ceil(std::log10(low) - kSlack), last = std::floor(std::log10(high) + kSlack);
  const bool plain = low >= 1e-3 * (1 - kSlack) && high < 1e5;  // one notation an axis
  const auto label = [&](double value) {
    const int exponent = static_cast<int>(std::floor(std::log10(value) + kSlack));
    if (plain) return number_text(value, std::max(0, -exponent));
    const double mantissa = value / std::pow(10.0, exponent);
    return (mantissa > 1.5 ? number_text(mantissa, 0) + "\u00B7" : "") + power_of_ten_text(exponent);
  };
  // Of few decades 1, 2 and 5 where they fit; of less than one plain numbers where even they are too coarse.
  if (const bool one = last - first < 1; one || (plain && last - first < 2)) {
    for (double decade = first - 1; decade <= last + 1; ++decade) {
      for (int m = 1; m <= 9; ++m) {
        const double v = m * std::pow(10.0, decade);
        if (v < low * (1 - kSlack) || v > high * (1 + kSlack)) continue;
        if (m == 1 || m == 2 || m == 5)
          ticks.major.push_back({v, label(v)});
        else
          ticks.minor.push_back(v);
      }
    }
    if (one && ticks.major.size() < 2) return linear_ticks(low, high, most);
    if (one || ticks.major.size() <= static_cast<std::size_t>(std::max(1, most))) return ticks;
    ticks = {};
  }
  const double every = std::max(1.0, std::ceil((last - first + 1) / std::max(1, most)));
  for (double decade = first - 1; decade <= last; ++decade) {
    const double v = std::pow(10.0, decade);
    if (decade >= first) {
      if (std::fmod(decade - first, every) == 0)
        ticks.major.push_back({v, label(v)});
      else
        ticks.minor.push_back(v);
    }
    if (every == 1) {
      for (int m = 2; m <= 9; ++m)
        if (m * v >= low && m * v <= high) ticks.minor.push_back(m * v);
    }
  }
  return ticks;
}

Ticks signed_log_ticks(double low, double high, double knee, int most) {
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest <= 2 * knee) return linear_ticks(low, high, most);
  for (int every = 0;; ++every) {  // 1, 2, 5; decades; every second of them…
    std::vector<double> sizes;
    for (double k = std::ceil(std::log10(knee) - kSlack); std::pow(10.0, k) <= largest;
         k += std::max(1, every)) {
      for (const double factor : {1.0, 2.0, 5.0})
        if (every == 0 || factor == 1.0) sizes.push_back(factor * std::pow(10.0, k));
    }
    Ticks ticks;
    const auto add = [&](double value) {
      if (value >= low && value <= high)
        ticks.major.push_back({value, number_text(value, value == 0 ? 0 : decimals_of(std::abs(value)))});
    };
    for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) add(-*size);
    add(0);
    for (const double size : sizes) add(size);
    if (static_cast<int>(ticks.major.size()) <= std::max(3, most) || sizes.size() < 2) return ticks;
  }
}

Ticks time_ticks(double low, double high, int most) {
  constexpr double kMinute = 60, kHour = 3600, kDay = 86400;
  static constexpr std::array<double, 23> kSteps = {
      1,        2,           5,           10,           15,           30,
      kMinute,  2 * kMinute, 5 * kMinute, 10 * kMinute, 15 * kMinute, 30 * kMinute,
      kHour,    2 * kHour,   3 * kHour,   6 * kHour,    12 * kHour,   kDay,
      2 * kDay, 5 * kDay,    10 * kDay,   20 * kDay,    50 * kDay};
  const double range = high - low;
  constexpr double kYear10000 = 253402300800;  // calendars go no further
  if (low < -kYear10000 || high > kYear10000) return linear_ticks(low, high, most);
  Ticks ticks;
  double step = nice_step(range / kDay, most) * kDay;
  for (const double candidate : kSteps) {
    if (range / candidate <= most - 1) {
      step = candidate;
      break;
    }
  }
  int decimals = 0;
  if (range / most < 0.5) {
    step = nice_step(range, most);
    decimals = decimals_of(step);
  }
  const auto utc = [](double seconds) {
    return fmt::gmtime(static_cast<std::time_t>(std::floor(seconds + 1e-7)));
  };
  // The axis names the day that it begins on: where another comes, its midnight names it.
  const bool days = step < kDay && high > (std::floor(low / kDay) + 1) * kDay;
  for_each_multiple(low, high, step, [&](double v) {
    std::string label = step >= kDay      ? fmt::format("{:%m-%d}", utc(v))
                        : step >= kMinute ? fmt::format("{:%H:%M}", utc(v))
                                          : fmt::format("{:%H:%M:%S}", utc(v));
    if (decimals > 0) label += fmt::format("{:.{}f}", v - std::floor(v + 1e-7), decimals).substr(1);
    if (days && std::abs(std::remainder(v, kDay)) < 1e-6) label += fmt::format("\n{:%m-%d}", utc(v));
    ticks.major.push_back({v, std::move(label)});
  });
  ticks.suffix = step >= kDay ? fmt::format("{:%Y} UTC", utc(low)) : fmt::format("{:%Y-%m-%d} UTC", utc(low));
  return ticks;
}

}  // namespace waverig::render
