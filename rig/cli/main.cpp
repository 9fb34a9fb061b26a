// waverig: the program. Every command in a file of its own; here only what they share: the parser, and how an
// error becomes an exit status and one line on stderr.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "lcmtypes/error.h"
#include "rig/cli/commands.h"
#include "rig/version.h"

namespace {

enum ExitStatus { kDone = 0, kAnswerIsNo = 1, kBadInput = 2 };

int fail(ExitStatus status, const char* message) {
  std::fprintf(stderr, "waverig: %s\n", message);
  return status;
}

// CLI11 tells of a missing command where the one given is unknown.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string known;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(argv[1])) return;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw waverig::UserError(std::string("\"") + argv[1] + "\" is no command; expected one of " + known);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace waverig;
  CLI::App app{"waverig: how well does a low-cost sensor, with its estimator, measure waves?"};
  app.set_version_flag("--version", std::string("waverig ") + kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Examples:\n"
      "  waverig sweep rig/default.toml --out results/table2      plan, run, evaluate, draw\n"
      "  waverig plan rig/default.toml                            what would run, and what cannot\n"
      "  waverig estimate recording.csv.gz --out results/mine     heave and waves of a recording\n"
      "Each command explains itself with --help.");

  cli::Command chosen;
  for (const auto add : cli::kCommands) add(app, chosen);

  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return chosen();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kBadInput, error.what());
  } catch (const UserError& error) {
    return fail(kBadInput, error.what());
  } catch (const NegativeAnswer& error) {
    return fail(kAnswerIsNo, error.what());
  } catch (const std::exception& error) {
    return fail(kAnswerIsNo, error.what());
  }
}
