// Times figures for tests/render/benchmark.py.
//   render_bench figure OUT.png    three panels of 10,000 samples, once: for cold starts
//   render_bench serve OUT.png     the same again for each line on stdin; prints its milliseconds
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include "motion/kinematics/random.h"
#include "render/figure_writer.h"

namespace {

using namespace waverig;

render::Figure three_panels() {
  render::Figure figure{
      .title = "Three traces", .share_x = true, .width_mm = 203.2, .height_mm = 152.4};  // 1600 x 1200
  RandomStream noise(1, "bench");
  for (int panel = 0; panel < 3; ++panel) {
    render::Line line{.name = "trace"};
    for (int i = 0; i < 10000; ++i) {
      line.x.push_back(0.03 * i);
      line.y.push_back(0.5 * std::cos(0.52 * line.x.back() + panel) + noise.gaussian(0.02));
    }
    figure.panels.push_back({.title = "Panel",
                             .x = {.label = "Time", .unit = "s"},
                             .y = {.label = "Heave", .unit = "m"},
                             .marks = {std::move(line)}});
  }
  return figure;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what != "figure" && what != "serve") return 2;
  const std::filesystem::path out = argv[2];
  const render::Figure figure = three_panels();
  render::Canvas canvas;
  if (what == "figure") render::save_png(figure, canvas, out, {});
  for (std::string line; what == "serve" && std::getline(std::cin, line);) {
    const auto start = std::chrono::steady_clock::now();
    render::save_png(figure, canvas, out, {});
    std::printf("%.3f\n",
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    std::fflush(stdout);
  }
  return 0;
}
