// The order of methods, and so their colours, in every figure.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace waverig::render {

inline constexpr const char* kBaselineMethod = "lee2014";  // what was published comes first

inline std::vector<std::string> in_order(std::vector<std::string> methods) {
  std::stable_partition(methods.begin(), methods.end(),
                        [](const std::string& m) { return m == kBaselineMethod; });
  return methods;
}

}  // namespace waverig::render
