// waverig compare: two campaigns, cell by cell.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "estimator/evaluation/compare.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "rig/cli/commands.h"
#include "rig/cli/recording.h"

namespace waverig::cli {
namespace {

struct CompareArguments {
  std::string baseline, candidate, csv;
};

int compare(const CompareArguments& arguments) {
  const auto baseline = evaluation::read_results(arguments.baseline);
  const auto candidate = evaluation::read_results(arguments.candidate);
  const auto cells = evaluation::compare_cells(baseline.cells, candidate.cells);
  if (!evaluation::any_common(cells))
    throw UserError(
        fmt::format("{} and {}: no period, height and method in common; expected two campaigns of one kind",
                    arguments.baseline, arguments.candidate));
  refuse_to_overwrite_results("--csv", arguments.csv, {arguments.baseline, arguments.candidate});
  if (!arguments.csv.empty()) write_atomically(arguments.csv, evaluation::comparison_csv(cells));
  fmt::print("{}", evaluation::comparison_table(cells));
  return evaluation::any_worse(cells) ? 1 : 0;
}

}  // namespace

void add_compare(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Hold a campaign against a baseline, cell by cell");
  command->add_option("baseline", arguments->baseline, "Results directory to compare with")->required();
  command->add_option("directory", arguments->candidate, "Results directory to judge")->required();
  command->add_option("--csv", arguments->csv, "Write the comparison into this file too");
  command->footer(
      "A cell is better or worse where mean error, standard deviation or, of a sea, the error of Hm0 or the\n"
      "rms of the heave's error differ by more than two standard uncertainties of the difference; a method\n"
      "that states none is not judged by it. That of the heave is told by its repeats, two at least in each\n"
      "campaign, with Student's factor for few, and so is, of a sea, that of single waves (std cm: the rms "
      "of\n"
      "their errors there).\n"
      "Exit status 1 where any cell is worse.\n"
      "Example:\n  waverig compare results/before results/after --csv comparison.csv");
  command->callback([arguments, &chosen] { chosen = [arguments] { return compare(*arguments); }; });
}

}  // namespace waverig::cli
