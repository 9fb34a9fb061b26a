// waverig calibrations: the history of the front end's calibrations.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "render/figure_writer.h"
#include "rig/bench/history.h"
#include "rig/bench/report/control_chart.h"
#include "rig/bench/results.h"
#include "rig/cli/commands.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

using namespace rig::bench;
using estimator::FrontEndCalibration;
using estimator::FrontEndChannel;

struct CalibrationsArguments {
  std::string history = "results/calibrations", one, other, chart;
  bool same_reference = false;
};

int list(const CalibrationsArguments& arguments) {
  const std::vector<FrontEndCalibration> all = History(arguments.history).all();
  fmt::print("{:<54} {:<21} {:<28} {:>8} {:>12} {:>12}\n", "id", "measured", "unit", "channels", "scale U",
             "bias U");
  for (const FrontEndCalibration& c : all) {
    double scale = 0, bias = 0;
    for (const FrontEndChannel& channel : c.channels) {
      if (measured(c, channel, Coefficient::kScaleN)) scale = std::max(scale, scale_expanded(channel));
      if (measured(c, channel, Coefficient::kBias)) bias = std::max(bias, bias_expanded_A(channel));
    }
    fmt::print("{:<54} {:<21} {:<28} {:>8} {:>12} {:>12}\n", c.id, c.measured, c.unit, c.channels.size(),
               scale > 0 ? shown(scale, "1") : "-", bias > 0 ? shown(bias, "A") : "-");
  }
  return 0;
}

int show(const CalibrationsArguments& arguments) {
  const FrontEndCalibration c = History(arguments.history).find(arguments.one);
  fmt::print("{}\nunit        {}\nprocedure   {}\nmeasured    {}\nversion     {}\n", c.id, c.unit,
             c.procedure, c.measured, c.version);
  for (const std::string& i : c.instruments) fmt::print("instrument  {}\n", i);
  for (const std::string& f : c.files) fmt::print("file        {}\n", f);
  fmt::print("\nAt 20 degC, U: k = 2\n{:<10} {:<16} {:>14} {:>12}  {}\n", "channel", "quantity", "value", "U",
             "standard uncertainties (k = 1)");
  const auto line = [&](const FrontEndChannel& channel, Coefficient q,
                        const std::vector<estimator::BudgetTerm>& budget) {
    if (!measured(c, channel, q)) return;
    const Told t = told(c, channel, q, 20, false);
    std::string terms;
    for (const estimator::BudgetTerm& term : budget)
      terms += fmt::format("{}{} {} ({})", terms.empty() ? "" : ", ", term.name,
                           shown(term.sigma, base_of(q)), term.type);
    fmt::print("{:<10} {:<16} {:>14} {:>12}  {}\n", channel.name, name_of(q), shown(t.value, base_of(q)),
               shown(t.expanded, base_of(q)), terms);
  };
  for (const FrontEndChannel& channel : c.channels) {
    line(channel, Coefficient::kScaleN, channel.dsf_N_budget);
    line(channel, Coefficient::kScaleP, channel.dsf_P_budget);
    line(channel, Coefficient::kBias, channel.bias_budget);
  }
  line({}, Coefficient::kOscillator, c.oscillator_budget);
  return 0;
}

// Every calibration of the unit, these two among them.
std::vector<FrontEndCalibration> of_unit(const History& history, const std::string& directory,
                                         const FrontEndCalibration& a, const FrontEndCalibration& b) {
  std::vector<FrontEndCalibration> list;
  if (std::filesystem::is_directory(directory)) list = history.all();
  std::erase_if(list, [&](const FrontEndCalibration& c) { return c.unit != a.unit; });
  for (const FrontEndCalibration* c : {&a, &b})
    if (std::ranges::find(list, c->id, &FrontEndCalibration::id) == list.end()) list.push_back(*c);
  std::ranges::stable_sort(list, {}, &FrontEndCalibration::measured);
  return list;
}

int compare_two(const CalibrationsArguments& arguments) {
  const History history(arguments.history);
  const FrontEndCalibration a = history.find(arguments.one), b = history.find(arguments.other);
  const std::vector<Drift> drifts = compare(a, b, arguments.same_reference);
  fmt::print("From {} ({})\nto   {} ({})\n\n{:<10} {:<18} {:>8} {:>14} {:>12} {:>7}\n", a.id, a.measured,
             b.id, b.measured, "channel", "quantity", "at degC", "difference", "U (k = 2)", "E_n");
  for (const Drift& d : drifts)
    fmt::print("{:<10} {:<18} {:>8.1f} {:>14} {:>12} {:>7.2f}  {}\n", d.channel, name_of(d.quantity),
               d.temperature_degC, shown(d.difference, base_of(d.quantity)),
               shown(d.expanded, base_of(d.quantity)), d.score(), d.significant() ? "drifted" : "");
  const auto drifted = std::ranges::count_if(drifts, &Drift::significant);
  fmt::print("\n{} of {} have drifted significantly.\n", drifted, drifts.size());
  if (!arguments.chart.empty()) {
    render::Canvas canvas;
    render::save_png(control_chart(of_unit(history, arguments.history, a, b), arguments.same_reference),
                     canvas, arguments.chart,
                     {kVersion, "waverig calibrations compare " + a.id + " " + b.id, ""});
    fmt::print("Control chart: {}\n", arguments.chart);
  }
  return drifted > 0 ? 1 : 0;
}

}  // namespace

void add_calibrations(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CalibrationsArguments>();
  CLI::App* command = app.add_subcommand("calibrations", "The history of the front end's calibrations");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* what, int (*run)(const CalibrationsArguments&)) {
    CLI::App* sub = command->add_subcommand(name, what);
    sub->add_option("--history", arguments->history, "Directory that waverig bench keeps calibrations in")
        ->capture_default_str();
    sub->callback([arguments, run, &chosen] { chosen = [arguments, run] { return run(*arguments); }; });
    return sub;
  };
  add("list", "All of them, in the order of measurement", list)
      ->footer("Example:\n  waverig calibrations list --history /data/calibrations");
  CLI::App* one = add("show", "One with its instruments, files, version and uncertainties", show);
  one->add_option("id", arguments->one, "Id, or a calibration file")->required();
  one->footer(
      "Examples:\n"
      "  waverig calibrations show unit7-scale_factor-20240101T000000\n"
      "  waverig calibrations show results/scale/calibration.json");
  CLI::App* two =
      add("compare", "What has drifted from one to another, and whether it is significant", compare_two);
  two->add_option("a", arguments->one, "Id of the earlier, or a calibration file")->required();
  two->add_option("b", arguments->other, "Id of the later, or a calibration file")->required();
  two->add_option("--chart", arguments->chart, "Draw the control chart of the unit's history into this PNG");
  two->add_flag(
      "--same-reference", arguments->same_reference,
      "The same calibrator and generator, not adjusted in between: their own errors are common and cancel");
  two->footer(
      "A drift is significant where it exceeds its expanded uncertainty (E_n > 1). Exit status 1 where any "
      "is.\n"
      "Examples:\n"
      "  waverig calibrations compare unit7-scale_factor-20240101T000000 unit7-scale_factor-20250101T000000\n"
      "  waverig calibrations compare first/calibration.json again/calibration.json --same-reference");
  command->footer(
      "Examples:\n"
      "  waverig calibrations list\n"
      "  waverig calibrations show unit7-scale_factor-20240101T000000\n"
      "  waverig calibrations compare unit7-scale_factor-20240101T000000 unit7-scale_factor-20250101T000000 "
      "--chart drift.png");
}

}  // namespace waverig::cli
