// waverig bench: a calibration sequence of the front end, against simulated or real instruments.
#include "rig/bench/bench.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "rig/bench/history.h"
#include "rig/bench/report/live_view.h"
#include "rig/bench/report/report.h"
#include "rig/campaign/sensor_unit.h"
#include "rig/cli/bench_terminal.h"
#include "rig/cli/commands.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;
using namespace rig::bench;

constexpr std::chrono::milliseconds kLiveRefresh{2000};

struct BenchArguments {
  std::string sequence, out, simulation, unit_of, scale_factors, history;
  bool simulate = false, dry_run = false, resume = false, unattended = false;
};

std::string command_line(const BenchArguments& a) {
  std::string text = "waverig bench " + a.sequence;
  if (a.simulate) text += " --simulate";
  if (!a.simulation.empty()) text += " --simulation " + a.simulation;
  if (!a.unit_of.empty()) text += " --unit-of " + a.unit_of;
  if (!a.scale_factors.empty()) text += " --scale-factors " + a.scale_factors;
  return text + " --out " + a.out;
}

BenchOptions options_for(const BenchArguments& arguments) {
  if (arguments.out.empty()) throw UserError("--out is missing: expected the run's directory, or --dry-run");
  BenchOptions options;
  options.out = arguments.out;
  options.simulate = arguments.simulate;
  if (!arguments.simulation.empty()) options.simulation = load_simulation(arguments.simulation);
  if (!arguments.unit_of.empty()) {
    const rig::CampaignSettings campaign = rig::read_campaign(arguments.unit_of).settings;
    const auto converter = rig::fresh_unit(campaign).converter;
    options.simulation.world.converter.assign(converter.begin(), converter.end());
    options.simulation.world.master_clock_error = rig::unit_settings(campaign).front_end.master_clock_error;
  }
  options.version = kVersion;
  options.resume = arguments.resume;
  return options;
}

// The scale factors that a bias run goes by are kept with it: a run that is gone on with finds them there.
void keep_scale_factors(const Sequence& sequence, const BenchArguments& arguments) {
  if (arguments.scale_factors.empty()) return;
  const estimator::FrontEndCalibration known = estimator::load_front_end_calibration(arguments.scale_factors);
  for (const UnitDescription::Channel& c : sequence.laboratory.unit.channels)
    known.channel(c.name);  // refused now, not after a weekend
  if (!arguments.resume && Store::begun(store_file(arguments.out))) return;  // run_bench refuses
  fs::create_directories(arguments.out);
  save(known, kept_scale_factors(arguments.out));
}

fs::path history_of(const BenchArguments& arguments) {
  return arguments.history.empty()
             ? fs::absolute(arguments.out).lexically_normal().parent_path() / "calibrations"
             : fs::path(arguments.history);
}

// Refused now, not after a weekend.
void check_history(const fs::path& history) {
  fs::path there = fs::absolute(history);
  std::error_code error;
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error) || ::access(there.c_str(), W_OK | X_OK) != 0)
    throw UserError(
        fmt::format("{}: cannot be made or written: expected a directory for the history", history.string()));
}

// What the run measured, written beside its store. Returns the exit status.
int conclude(const Sequence& sequence, const BenchArguments& arguments, const BenchResult& result) {
  const fs::path out = arguments.out;
  const Store store = Store::open(store_file(out));
  std::optional<estimator::FrontEndCalibration> known;
  if (fs::exists(kept_scale_factors(out)))
    known = estimator::load_front_end_calibration(kept_scale_factors(out));
  const std::optional<Analysis> analysis =
      result.complete ? analyse_run(sequence, store, known ? &*known : nullptr) : std::nullopt;
  std::vector<Verdict> verdicts;
  if (analysis) {
    verdicts = hold_against_limits(sequence, *analysis);
    save(analysis->calibration, out / "calibration.json");
    write_atomically(out / "channels.csv", channels_csv(*analysis));
    fmt::print("{}", table_of(verdicts));
    const fs::path history = history_of(arguments);
    fmt::print("Kept:    {} in {}\n", History(history).keep(analysis->calibration), history.string());
  }
  write_atomically(out / "steps.csv", steps_csv(store));
  write_atomically(out / "junit.xml", junit_xml(sequence, store, verdicts));
  const Analysis* found = analysis ? &*analysis : nullptr;
  const std::vector<BenchFigure> figures = bench_figures(sequence, store, found);
  draw_figures(figures, out, kVersion);
  write_atomically(out / "report.html", bench_report_html(sequence, store, found, verdicts, figures, out,
                                                          command_line(arguments)));
  const bool passed = std::ranges::all_of(verdicts, &Verdict::passed);
  fmt::print("Outcome: {}{}\nResults: {}\nReport:  {}\n", result.outcome, passed ? "" : ", limits exceeded",
             arguments.out, (out / "report.html").string());
  return result.outcome == "done" && passed ? 0 : 1;
}

int bench(const BenchArguments& arguments) {
  const Sequence sequence = load_sequence(arguments.sequence);
  if (arguments.dry_run) {
    fmt::print("{}", describe(sequence));
    return 0;
  }
  BenchOptions options = options_for(arguments);
  check_history(history_of(arguments));
  keep_scale_factors(sequence, arguments);
  StopOnSignal signals;
  BenchResult result;
  {
    BenchTerminal terminal;
    LiveView live(sequence, arguments.out, kLiveRefresh);
    if (arguments.resume) live.take_over(Store::open(store_file(options.out)));
    options.stop = &signals.asked();
    options.clear_stop = [&] { signals.clear(); };
    options.progress = [&](const Progress& progress) {
      terminal.show(progress);
      live.show(progress);
    };
    options.trace = [&](const TraceRow& row) { live.add(row); };
    if (terminal.interactive() && !arguments.simulate && !arguments.unattended)
      options.prompt = [&](const PlannedStep& step) { return terminal.ask(step.text); };
    result = run_bench(sequence, options);
    live.draw();
  }
  return conclude(sequence, arguments, result);
}

}  // namespace

void add_bench(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command =
      app.add_subcommand("bench", "Carry out a calibration sequence of the front end, unattended");
  command->add_option("sequence", arguments->sequence, "Sequence file (TOML)")->required();
  command->add_option("--out", arguments->out,
                      "The run's directory: its store, calibration file, CSV, JUnit XML, report");
  command->add_flag("--simulate", arguments->simulate,
                    "Start simulated instruments and run in virtual time, as fast as the machine goes");
  command
      ->add_option("--simulation", arguments->simulation,
                   "With --simulate: which laboratory, and what goes wrong there (TOML)")
      ->needs("--simulate");
  command
      ->add_option("--unit-of", arguments->unit_of,
                   "With --simulate: accel_1 to accel_3 are the front end of this campaign's sensor unit")
      ->needs("--simulate");
  auto* dry = command->add_flag("--dry-run", arguments->dry_run,
                                "Check everything, print the plan and its total time, command nothing");
  command->add_flag("--resume", arguments->resume, "Go on where a run in --out was killed")->excludes(dry);
  command->add_flag("--unattended", arguments->unattended,
                    "Answer prompts with the sequence's own defaults, on a terminal too");
  command->add_option(
      "--scale-factors", arguments->scale_factors,
      "For a bias run: calibration file of a scale-factor run of the same unit; the result then holds both");
  command->add_option("--history", arguments->history,
                      "Directory to keep the calibration in; calibrations beside --out by default");
  command->footer(
      "Exit status 1 where the run ended early, a step failed or a limit is exceeded. SIGINT, SIGTERM and "
      "SIGHUP end a run safely:\n"
      "calibrator off, chamber to ambient.\n"
      "Examples:\n"
      "  waverig bench rig/sequences/scale_factor.toml --dry-run\n"
      "  waverig bench rig/sequences/scale_factor.toml --simulate --out results/scale\n"
      "  waverig bench rig/sequences/scale_factor_dmm.toml --simulate --out results/scale_dmm      by the "
      "multimeter\n"
      "  waverig bench rig/sequences/bias.toml --simulate --out results/bias --scale-factors "
      "results/scale/calibration.json\n"
      "  waverig bench rig/sequences/scale_factor.toml --out /data/unit7 --resume      after a power loss");
  command->callback([arguments, &chosen] { chosen = [arguments] { return bench(*arguments); }; });
}

}  // namespace waverig::cli
