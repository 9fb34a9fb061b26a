// Times films and whole sets of figures for tests/render/benchmark.py.
//   campaign_bench film OUT.mp4      60 frames at 1280x720 of an example run; prints its milliseconds
//   campaign_bench figures OUT_DIR   every figure of an example campaign on two threads; prints its
//   milliseconds
#include <chrono>
#include <cstdio>
#include <string>

#include "render/campaign_figures.h"
#include "render/scene/film.h"
#include "tests/render/example_campaign.h"

namespace {

using namespace waverig;

void film(const evaluation::RunRecord& run, const std::filesystem::path& out) {
  const render::RigMotion motion(run, "");
  render::write_film(motion, {.begin_s = 60, .duration_s = 2}, out, {});
}

void figures(const evaluation::RunRecord& run, const std::filesystem::path& out) {
  const evaluation::CampaignResults results = test::example_campaign();
  render::FigureOptions options;
  options.threads = 2;
  std::vector<render::NamedFigure> all = render::run_figures(results, run, options);
  for (render::NamedFigure& figure : render::result_figures(results)) all.push_back(std::move(figure));
  render::write_figures(all, out, options);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what != "film" && what != "figures") return 2;
  const evaluation::RunRecord run = test::example_run(12, 1.0, 300);
  (what == "film" ? film : figures)(run, argv[2]);
  return 0;
}
