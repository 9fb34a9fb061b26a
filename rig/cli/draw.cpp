#include "rig/cli/draw.h"

#include <fmt/format.h>

#include "estimator/evaluation/results_files.h"
#include "render/campaign_figures.h"
#include "rig/campaign/reestimate.h"

namespace waverig::cli {
namespace {

constexpr const char* kPaperMethod = "lee2014";

render::PaperTraces uncalibrated_traces(const evaluation::RunRecord& run, const rig::CampaignUnit& unit) {
  rig::Reestimated again = rig::estimate_uncalibrated(run, unit, kPaperMethod);
  return {kPaperMethod, std::move(again.imu), std::move(again.heave), std::move(again.waves)};
}

}  // namespace

std::vector<std::filesystem::path> draw_campaign(const evaluation::CampaignResults& results,
                                                 const std::filesystem::path& directory,
                                                 const rig::CampaignUnit& unit, int jobs,
                                                 const DrawOptions& wanted) {
  render::FigureOptions options;
  options.theme = wanted.dark ? render::Theme::kDark : render::Theme::kPrint;
  options.svg = wanted.svg;
  options.threads = jobs;
  options.provenance = {results.version, results.command, fmt::format("{}", results.seed)};
  options.uncalibrated = [&unit](const evaluation::RunRecord& run) { return uncalibrated_traces(run, unit); };
  return render::draw_campaign_figures(results, evaluation::runs_of(directory), directory / "figures",
                                       options);
}

}  // namespace waverig::cli
