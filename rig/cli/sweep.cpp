// waverig sweep and waverig plan.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "estimator/evaluation/results_files.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "render/report/report.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/commands.h"
#include "rig/cli/draw.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/signals.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

constexpr const char* kCampaignHelp =
    "Campaign file (TOML); without it the default campaign, Table 2 of Lee 2014";

struct SweepArguments {
  std::string campaign, out, shard;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::optional<std::uint64_t> seed;
  bool resume = false, replace = false;
};

rig::Shard parse_shard(const std::string& text) {
  rig::Shard shard;
  char rest = 0;
  if (text.empty()) return shard;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.number, &shard.of, &rest) != 2 || shard.of < 1 ||
      shard.number < 1 || shard.number > shard.of)
    throw UserError(fmt::format("--shard {}: expected K/N with 1 <= K <= N, e.g. 2/8", text));
  return shard;
}

rig::ResultsDirectory::Mode mode_of(const SweepArguments& arguments) {
  using Mode = rig::ResultsDirectory::Mode;
  return arguments.resume ? Mode::kResume : arguments.replace ? Mode::kReplace : Mode::kFresh;
}

int sweep(const SweepArguments& arguments) {
  const rig::Campaign campaign =
      rig::read_campaign(arguments.campaign, arguments.seed ? &*arguments.seed : nullptr);
  const rig::Shard shard = parse_shard(arguments.shard);
  const rig::CampaignPlan plan = rig::plan_campaign(campaign.settings);
  rig::refuse_impossible(campaign.settings, plan);

  rig::ResultsDirectory directory(arguments.out, mode_of(arguments));
  directory.claim(campaign.resolved, kVersion);
  set_last_words(
      fmt::format("{}waverig: interrupted; {} keeps the runs that are done, --resume goes on with them\n",
                  isatty(STDERR_FILENO) ? "\n" : "", directory.working().string()));
  if (const auto& front_end = campaign.settings.calibration.front_end)
    estimator::save(front_end->calibration, directory.working() / rig::kFrontEndFile);
  const rig::CalibratedUnit calibrated = rig::calibrate(campaign.settings);
  if (!calibrated.report_json.empty())
    write_atomically(directory.working() / evaluation::kCalibrationFile, calibrated.report_json);

  const rig::SweepOptions options{
      .jobs = arguments.jobs,
      .shard = shard,
      .command = fmt::format(
          "waverig sweep {}--seed {}{}", arguments.campaign.empty() ? "" : arguments.campaign + " ",
          campaign.settings.seed, arguments.shard.empty() ? "" : " --shard " + arguments.shard),
      .version = kVersion};
  const evaluation::CampaignResults results =
      rig::run_campaign(campaign, calibrated, rig::runs_of_shard(plan, shard), directory, options);
  draw_campaign(results, directory.working(), calibrated.unit, arguments.jobs);
  write_atomically(directory.working() / "report.html", render::report_html(results, directory.working()));
  set_last_words({});
  directory.finish();
  fmt::print("{}\nResults: {}\nReport:  {}\n", rig::results_table(results, campaign.settings.sweep.mover),
             arguments.out, (std::filesystem::path(arguments.out) / "report.html").string());
  return 0;
}

int plan(const std::string& file) {
  const rig::Campaign campaign = rig::read_campaign(file);
  const rig::CampaignPlan planned = rig::plan_campaign(campaign.settings);
  fmt::print("{}", rig::described(campaign.settings, planned));
  const bool refused =
      std::any_of(planned.settings.begin(), planned.settings.end(), [](const auto& s) { return s.refused; });
  return refused && campaign.settings.sweep.outside == rig::OutsideEnvelope::kRefuse ? 1 : 0;
}

}  // namespace

void add_sweep(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand("sweep", "Plan a campaign, run it, judge it and draw it");
  command->add_option("campaign", arguments->campaign, kCampaignHelp);
  command->add_option("--out", arguments->out, "Results directory, made anew")->required();
  command->add_option("--jobs", arguments->jobs, "Runs at a time; the results do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Instead of the campaign's seed")->check(seed());
  command->add_option("--shard", arguments->shard,
                      "K/N: only the Kth of N parts, for many machines; then waverig merge");
  auto* resume = command->add_flag("--resume", arguments->resume, "Go on with an interrupted campaign");
  command
      ->add_flag("--replace", arguments->replace,
                 "Replace results that are there, once the new ones are whole")
      ->excludes(resume);
  command->footer(
      "Examples:\n"
      "  waverig sweep --out results/table2\n"
      "  waverig sweep rig/campaigns/regular.toml --out results/regular --jobs 2\n"
      "  waverig sweep rig/campaigns/regular.toml --out results/regular --resume\n"
      "  waverig sweep big.toml --out results/part3 --shard 3/16");
  command->callback([arguments, &chosen] { chosen = [arguments] { return sweep(*arguments); }; });
}

void add_plan(CLI::App& app, Command& chosen) {
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("plan", "Say what a campaign would run, and what cannot work and why");
  command->add_option("campaign", *file, kCampaignHelp);
  command->footer(
      "Exit status 1 where a setting is refused and the campaign does not skip such.\n"
      "Example:\n  waverig plan rig/default.toml");
  command->callback([file, &chosen] { chosen = [file] { return plan(*file); }; });
}

}  // namespace waverig::cli
