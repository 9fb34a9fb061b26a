// waverig node evaluator: hears truth, setting and every method on the bus, and judges one run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "estimator/method.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/error.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/chosen_run.h"
#include "rig/cli/nodes/listen.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/nodes/evaluator_node.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;

// A place for the results that nothing else has; DIR.partial until the run is judged.
rig::ResultsDirectory new_directory(const EvaluatorArguments& arguments) {
  const fs::path out(arguments.out);
  if (!arguments.replace && fs::exists(out) && !fs::is_empty(out))
    throw UserError(fmt::format(
        "--out {}: is there already; expected a new directory, or --replace to do it anew", arguments.out));
  fs::path unfinished = out.filename().empty() ? out.parent_path() : out;
  unfinished += ".partial";
  // What an evaluator leaves there is worth nothing: it judged no run. A sweep's runs are another matter.
  const fs::path logs = evaluation::runs_of(unfinished);
  if (!arguments.replace && fs::exists(logs) && !fs::is_empty(logs))
    throw UserError(
        fmt::format("--out {}: {} holds runs of an unfinished sweep; expected a new directory, or --replace",
                    arguments.out, unfinished.string()));
  return {out, rig::ResultsDirectory::Mode::kReplace, /*resumes=*/false};
}

void refuse_unless_whole(Ending ending, const rig::RunWatch& watch, const std::string& run) {
  if (!watch.stopped().empty())
    throw NegativeAnswer(fmt::format("run {}: nothing judged: the motion: {}", run, watch.stopped()));
  if (ending == Ending::kMotionSilent)
    throw NegativeAnswer(
        fmt::format("run {}: nothing judged: the motion node fell silent inside the record", run));
  if (ending == Ending::kToldToStop)
    throw NegativeAnswer(fmt::format("run {}: nothing judged: stopped before the end of the record", run));
  if (watch.estimates() == 0)
    throw NegativeAnswer(fmt::format("run {}: nothing judged: no estimator was heard on the bus", run));
}

}  // namespace

int run_evaluator(const EvaluatorArguments& arguments) {
  evaluation::CampaignResults results;
  evaluation::JudgeSettings judging{.tells_waves = estimator::tells_waves};
  std::string resolved;
  results.name = arguments.run;
  if (!arguments.campaign.empty()) {
    const rig::Campaign campaign = rig::read_campaign(arguments.campaign);
    chosen_run(arguments.campaign, arguments.run);  // refused now, not after the run
    judging = rig::judge_settings(unit_on_the_rig(campaign.settings, {}));
    results.seed = campaign.settings.seed;
    results.name = campaign.settings.name;
    resolved = campaign.resolved;
  }
  rig::ResultsDirectory directory = new_directory(arguments);
  if (!resolved.empty()) directory.claim(resolved, kVersion);

  Requests requests;
  Bus bus = open_bus(arguments.bus);
  const rig::RunWatch watch(bus);
  rig::EvaluatorNode node(bus, arguments.run, judging);
  fmt::print(stderr, "evaluator: ready\n");
  const Ending ending = listen_to_record(bus, requests, watch, arguments.quiet_s);
  if (node.truths_missing() > 0)
    fmt::print(stderr, "evaluator: {} messages of the truth were lost on the bus\n", node.truths_missing());
  refuse_unless_whole(ending, watch, arguments.run);

  results.version = kVersion;
  results.command = fmt::format("waverig node evaluator --run {}", arguments.run);
  results.complete = true;
  results.runs = node.finish();
  results.cells = evaluation::cells_of(results.runs);
  if (std::ranges::none_of(results.cells, [](const evaluation::CellResult& cell) {
        return std::isfinite(cell.statistics.mean_true_height_m) || std::isfinite(cell.heave_rmse_m);
      }))
    fmt::print(stderr,
               "evaluator: no truth came on {}: waves are held against the set height alone, heave against "
               "nothing (on a real rig: node motion --tell-truth)\n",
               channel::kTruth);
  evaluation::write_results(directory.working(), results);
  directory.finish();
  fmt::print("{}\nResults: {}\n", rig::results_table(results, rig::Mover::kArm), arguments.out);
  return 0;
}

}  // namespace waverig::cli
