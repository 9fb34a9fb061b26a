// The order of methods, and so their colours, in every figure.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "render/figure.h"

namespace waverig::render {

inline constexpr const char* kBaselineMethod = "lee2014";  // what was published comes first

inline std::vector<std::string> in_order(std::vector<std::string> methods) {
  std::stable_partition(methods.begin(), methods.end(),
                        [](const std::string& m) { return m == kBaselineMethod; });
  return methods;
}

// The number of a method in the palette: its place among those of the campaign, so that it is the same in
// every figure; of methods that are not among them the next.
inline int method_color(const std::vector<std::string>& methods, const std::string& method) {
  return static_cast<int>(std::ranges::find(methods, method) - methods.begin());
}

// Methods that tell the very same, as two that publish one heave do, are drawn once and named together: the
// later would cover the earlier.
void draw_same_once(std::vector<Mark>& marks);

}  // namespace waverig::render
