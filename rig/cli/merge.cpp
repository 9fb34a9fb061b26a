// waverig merge: shards of one campaign become one results directory.
#include "estimator/evaluation/merge.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "render/report/report.h"
#include "rig/campaign/directory_lock.h"
#include "rig/campaign/plan.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/commands.h"
#include "rig/cli/draw.h"

namespace waverig::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
  bool replace = false;
};

// Nobody takes a shard away while it is read: neither another program, nor --replace where the shard is what
// an earlier one left unfinished. A shard that is named twice is held once: it is refused for that, not for
// this program's being at work in it.
std::vector<rig::DirectoryLock> held(const std::vector<std::filesystem::path>& shards) {
  std::vector<rig::DirectoryLock> locks;
  for (auto shard = shards.begin(); shard != shards.end(); ++shard) {
    std::error_code ignored;  // of a shard that is not there: refused by the lock
    if (std::any_of(shards.begin(), shard,
                    [&](const auto& before) { return std::filesystem::equivalent(before, *shard, ignored); }))
      continue;
    auto lock = rig::DirectoryLock::take(*shard);
    if (!lock)
      throw UserError(
          fmt::format("{}: another waverig is at work in it; expected a finished shard", shard->string()));
    locks.push_back(std::move(*lock));
  }
  return locks;
}

int merge(const MergeArguments& arguments) {
  const std::vector<std::filesystem::path> shards(arguments.shards.begin(), arguments.shards.end());
  const std::string command =
      fmt::format("waverig merge {} --out {}", fmt::join(arguments.shards, " "), arguments.out);
  const std::vector<rig::DirectoryLock> locks = held(shards);
  const rig::Campaign campaign = rig::read_campaign(shards.front() / evaluation::kSettingsFile);
  std::vector<std::string> expected_runs;
  for (const rig::RunPlan& run : rig::plan_campaign(campaign.settings).runs)
    expected_runs.push_back(run.name);
  evaluation::CampaignResults results = evaluation::merged(shards, expected_runs);
  results.command = command;

  using Mode = rig::ResultsDirectory::Mode;
  rig::ResultsDirectory directory(arguments.out, arguments.replace ? Mode::kReplace : Mode::kFresh,
                                  /*resumes=*/false);
  std::filesystem::remove(directory.runs());  // merge_into makes its own
  evaluation::merge_into(directory.working(), shards, results);
  if (const auto& front_end = campaign.settings.calibration.front_end)
    estimator::save(front_end->calibration, directory.working() / rig::kFrontEndFile);
  const int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  draw_campaign(results, directory.working(), rig::calibrate(campaign.settings).unit, jobs);
  write_atomically(directory.working() / "report.html", render::report_html(results, directory.working()));
  directory.finish();
  fmt::print("{}\nResults: {}\nReport:  {}\n", rig::results_table(results, campaign.settings.sweep.mover),
             arguments.out, (std::filesystem::path(arguments.out) / "report.html").string());
  return 0;
}

}  // namespace

void add_merge(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command =
      app.add_subcommand("merge", "Join the shards of one campaign, and draw and report them");
  command->add_option("shards", arguments->shards, "Results directories of waverig sweep --shard K/N")
      ->required();
  command->add_option("--out", arguments->out, "Results directory, made anew")->required();
  command->add_flag("--replace", arguments->replace,
                    "Replace results that are there, once the new ones are whole");
  command->footer(
      "Refuses shards of different settings, seed or version, shards that share a run, and too few of them.\n"
      "Example:\n  waverig merge results/part* --out results/all");
  command->callback([arguments, &chosen] { chosen = [arguments] { return merge(*arguments); }; });
}

}  // namespace waverig::cli
