// Times figures and films for tests/render/benchmark.py.
//   render_bench figure OUT.png    three panels of 10,000 samples, once: for cold starts
//   render_bench serve OUT.png     the same again for each line on stdin; prints its milliseconds
//   render_bench film OUT.mp4      60 frames at 1280x720; prints its milliseconds
//   render_bench campaign OUT_DIR  every figure of an example campaign on two threads; prints its
//   milliseconds
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

#include "motion/kinematics/random.h"
#include "render/campaign_figures.h"
#include "render/scene/film.h"
#include "tests/render/example_campaign.h"

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

template <class Work>
double milliseconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string what = argv[1], out = argv[2];
  if (what == "figure" || what == "serve") {
    const render::Figure figure = three_panels();
    render::Canvas canvas;
    const auto once = [&] { render::save_png(figure, canvas, out, {}); };
    if (what == "figure") once();
    for (std::string line; what == "serve" && std::getline(std::cin, line);) {
      std::printf("%.3f\n", milliseconds(once));
      std::fflush(stdout);
    }
    return 0;
  }
  const evaluation::RunRecord run = test::example_run(12, 1.0, 300);
  if (what == "film") {
    std::printf("%.0f\n", milliseconds([&] {
                  const render::RigMotion motion(run, "");
                  render::write_film(motion, {.begin_s = 60, .duration_s = 2}, out, {});
                }));
    return 0;
  }
  if (what == "campaign") {
    std::printf("%.0f\n", milliseconds([&] {
                  const evaluation::CampaignResults results = test::example_campaign();
                  render::FigureOptions options;
                  options.threads = 2;
                  auto figures = render::run_figures(results, run, options);
                  for (auto& figure : render::result_figures(results)) figures.push_back(std::move(figure));
                  render::write_figures(figures, out, options);
                }));
    return 0;
  }
  return 2;
}
