// waverig calibrate front-end: the calibration file of the front end from what a bench run has recorded.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "lcmtypes/error.h"
#include "rig/bench/results.h"
#include "rig/bench/run_directory.h"
#include "rig/cli/commands.h"
#include "rig/cli/recording.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;
using namespace rig::bench;
using estimator::FrontEndCalibration;

struct FrontEndArguments {
  std::string run, out, scale_factors;
};

// Those that were asked for, or else those that the run went by.
std::optional<FrontEndCalibration> known_scale_factors(const FrontEndArguments& arguments,
                                                       const Sequence& sequence) {
  const bool given = !arguments.scale_factors.empty();
  if (given && sequence.procedure != "bias")
    throw UserError(fmt::format("--scale-factors {}: expected it for a bias run; the procedure in {} is {}",
                                arguments.scale_factors, arguments.run, sequence.procedure));
  const fs::path file = given ? fs::path(arguments.scale_factors) : kept_scale_factors(arguments.run);
  if (!given && !fs::exists(file)) return std::nullopt;
  return estimator::load_front_end_calibration(file);
}

int calibrate_front_end(const FrontEndArguments& arguments) {
  refuse_to_overwrite(store_file(arguments.run), arguments.out);
  const Store store = Store::open(store_file(arguments.run));
  const RunInfo info = store.info();
  if (!info.outcome.starts_with("done"))
    throw UserError(fmt::format("{}: the run there has not come to its end ({}): expected one that is done",
                                arguments.run, info.outcome));
  const Sequence sequence = kept_sequence(arguments.run, info);
  const std::optional<FrontEndCalibration> known = known_scale_factors(arguments, sequence);
  std::optional<Analysis> analysis = analyse_run(sequence, store, known ? &*known : nullptr);
  if (!analysis)
    throw UserError(
        fmt::format("{}: procedure = \"none\": expected a run that calibrates something", arguments.run));
  if (info.version != kVersion) analysis->calibration.version += fmt::format(", calibrated by {}", kVersion);
  const std::vector<Verdict> verdicts = hold_against_limits(sequence, *analysis);
  save(analysis->calibration, arguments.out);
  fmt::print("{}Calibration: {}\n", table_of(verdicts), arguments.out);
  return std::ranges::all_of(verdicts, &Verdict::passed) ? 0 : 1;
}

}  // namespace

void add_calibrate_front_end(CLI::App& calibrate, Command& chosen) {
  auto arguments = std::make_shared<FrontEndArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "front-end", "Scale factors or bias of the current-to-frequency converter, from a bench run");
  command->add_option("run", arguments->run, "The run's directory, as waverig bench left it")->required();
  command->add_option("--out", arguments->out, "Calibration file to write (JSON)")->required();
  command->add_option("--scale-factors", arguments->scale_factors,
                      "For a bias run: calibration file of a scale-factor run of the same unit, in place of "
                      "the one that the run went by");
  command->footer(
      "The same file that the bench itself wrote, from its store and the sequence kept beside it; no "
      "instrument is needed.\n"
      "Exit status 1 where a limit of the unit is exceeded.\n"
      "Examples:\n"
      "  waverig calibrate front-end results/scale --out unit7.json\n"
      "  waverig calibrate front-end results/bias --scale-factors unit7.json --out unit7-bias.json");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return calibrate_front_end(*arguments); }; });
}

}  // namespace waverig::cli
