// waverig figures: draws a campaign's figures anew from its results directory.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <thread>

#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/commands.h"
#include "rig/cli/draw.h"

namespace waverig::cli {
namespace {

struct FigureArguments {
  std::string directory;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  DrawOptions draw;
};

int figures(const FigureArguments& arguments) {
  const std::filesystem::path directory = arguments.directory;
  const evaluation::CampaignResults results = evaluation::read_results(directory);
  const rig::Campaign campaign = rig::read_campaign(directory / evaluation::kSettingsFile);
  const rig::CalibratedUnit calibrated = rig::calibrate(campaign.settings);
  for (const auto& path : draw_campaign(results, directory, calibrated.unit, arguments.jobs, arguments.draw))
    fmt::print("{}\n", path.string());
  return 0;
}

}  // namespace

void add_figures(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<FigureArguments>();
  CLI::App* command = app.add_subcommand("figures", "Draw a campaign's figures anew");
  command->add_option("directory", arguments->directory, "Results directory of waverig sweep")->required();
  command->add_option("--jobs", arguments->jobs, "Threads; the pictures do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_flag("--dark", arguments->draw.dark, "For a dark screen instead of paper");
  command->add_flag("--svg", arguments->draw.svg, "The same figures as vectors too");
  command->footer("Prints the paths of the figures.\nExample:\n  waverig figures results/table2 --svg");
  command->callback([arguments, &chosen] { chosen = [arguments] { return figures(*arguments); }; });
}

}  // namespace waverig::cli
