// waverig merge: shards of one campaign become one results directory.
#include "estimator/evaluation/merge.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "estimator/evaluation/atomic_file.h"
#include "estimator/evaluation/results_io.h"
#include "render/report/report.h"
#include "rig/campaign/plan.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/commands.h"
#include "rig/cli/draw.h"

namespace waverig::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
};

int merge(const MergeArguments& arguments) {
  const std::vector<std::filesystem::path> shards(arguments.shards.begin(), arguments.shards.end());
  const std::string command =
      fmt::format("waverig merge {} --out {}", fmt::join(arguments.shards, " "), arguments.out);
  const rig::Campaign campaign = rig::read_campaign(shards.front() / "campaign.toml");
  std::vector<std::string> expected_runs;
  for (const rig::RunPlan& run : rig::plan_campaign(campaign.settings).runs)
    expected_runs.push_back(run.name);
  const auto results = evaluation::merge_into(arguments.out, shards, command, expected_runs);
  const std::filesystem::path out = arguments.out;
  const int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  draw_campaign(results, out, rig::calibrate(campaign.settings).unit, jobs);
  evaluation::write_atomically(out / "report.html", render::report_html(results, out));
  fmt::print("{}\nResults: {}\nReport:  {}\n", rig::results_table(results, campaign.settings.sweep.mover),
             arguments.out, (out / "report.html").string());
  if (const auto& front_end = campaign.settings.calibration.front_end)
    estimator::save(front_end->calibration, out / rig::kFrontEndFile);
  return 0;
}

}  // namespace

void add_merge(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command = app.add_subcommand("merge", "Join the shards of one campaign, and draw and report them");
  command->add_option("shards", arguments->shards, "Results directories of waverig sweep --shard K/N")
      ->required();
  command->add_option("--out", arguments->out, "Results directory, made anew")->required();
  command->footer(
      "Refuses shards of different settings, seed or version, shards that share a run, and too few of them.\n"
      "Example:\n  waverig merge results/part* --out results/all");
  command->callback([arguments, &chosen] { chosen = [arguments] { return merge(*arguments); }; });
}

}  // namespace waverig::cli
