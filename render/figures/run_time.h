// What the figures of a single run ask of its record.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "estimator/evaluation/run_record.h"
#include "render/figures/methods.h"

namespace waverig::render {

inline double since_start_s(const evaluation::RunRecord& run, std::int64_t utime) {
  return static_cast<double>(utime - run.start_utime) * kMicrosecond;
}

// A buoy on an irregular sea instead of the rig's arm: the set period and height are Tp and Hm0.
inline bool is_on_sea(const evaluation::RunRecord& run) {
  return !run.truth.empty() && !std::isfinite(run.truth.front().arm_angle_rad);
}

// Whose heave was recorded, in the order of the figures.
inline std::vector<std::string> heave_methods_of(const evaluation::RunRecord& run) {
  std::vector<std::string> methods;
  for (const auto& [method, samples] : run.heave) methods.push_back(method);
  return in_order(std::move(methods));
}

inline std::string setting_text(const evaluation::RunRecord& run) {
  return fmt::format("{} {:g} s, {} {:g} cm, repeat {}", is_on_sea(run) ? "peak period" : "wave period",
                     run.period_s, is_on_sea(run) ? "Hm0" : "wave height", run.height_m / kCentimetre,
                     run.repeat + 1);
}

}  // namespace waverig::render
