// waverig report: one page that holds everything a campaign found; or two campaigns side by side.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "estimator/evaluation/results_io.h"
#include "lcmtypes/atomic_file.h"
#include "render/report/report.h"
#include "rig/cli/commands.h"
#include "rig/cli/recording.h"

namespace waverig::cli {
namespace {
namespace fs = std::filesystem;

struct ReportArguments {
  std::string directory, baseline, out;
};

int report(const ReportArguments& arguments) {
  const fs::path directory = arguments.directory;
  const evaluation::CampaignResults results = evaluation::read_results(directory);
  const bool compares = !arguments.baseline.empty();
  const fs::path out = !arguments.out.empty() ? fs::path(arguments.out)
                                              : directory / (compares ? "comparison.html" : "report.html");
  refuse_to_overwrite_results("--out", out, {directory, arguments.baseline});
  write_atomically(out, compares ? render::comparison_html(evaluation::read_results(arguments.baseline),
                                                           arguments.baseline, results, directory)
                                 : render::report_html(results, directory));
  fmt::print("{}\n", out.string());
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand("report", "Write a campaign's report, or hold it against another's");
  command->add_option("directory", arguments->directory, "Results directory of waverig sweep")->required();
  command->add_option("--compare", arguments->baseline,
                      "Results directory to hold it against: better, worse, not significant");
  command->add_option("--out", arguments->out,
                      "HTML file; report.html or comparison.html of the directory by default");
  command->footer(
      "One self-contained page that opens offline. Prints its path.\n"
      "Examples:\n"
      "  waverig report results/table2\n"
      "  waverig report results/new --compare results/old --out new-against-old.html");
  command->callback([arguments, &chosen] { chosen = [arguments] { return report(*arguments); }; });
}

}  // namespace waverig::cli
