// waverig: the program. Every command in a file of its own; here only what they share: the parser, and how an
// error becomes an exit status and one line on stderr.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "rig/cli/commands.h"
#include "rig/cli/signals.h"
#include "rig/cli/streams.h"
#include "rig/version.h"

namespace {

enum ExitStatus { kDone = 0, kAnswerIsNo = 1, kBadInput = 2 };

// One line, whatever a file, a key or a value is called.
int fail(ExitStatus status, std::string message) {
  for (char& c : message)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = '?';
  std::fprintf(stderr, "waverig: %s\n", message.c_str());
  return status;
}

// A place that the user has named; where the machine fails, no other name would help.
int fail(const std::filesystem::filesystem_error& error) {
  const std::string sentence = error.path1().string() + ": " + error.code().message() +
                               "; expected a place that can be read and written";
  return fail(waverig::is_of_the_machine(error.code()) ? kAnswerIsNo : kBadInput, sentence);
}

// CLI11 tells of a missing command where the one given is unknown: commands of commands too.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  const CLI::App* of = &app;
  for (int i = 1; i < argc && argv[i][0] != '-' && !of->get_subcommands({}).empty(); ++i) {
    const CLI::App* found = nullptr;
    std::string known;
    for (const CLI::App* command : of->get_subcommands({})) {
      if (command->check_name(argv[i])) found = command;
      known += (known.empty() ? "" : ", ") + command->get_name();
    }
    if (found == nullptr)
      throw waverig::UserError(std::string("\"") + argv[i] + "\" is no command; expected one of " + known);
    of = found;
  }
}

// How every command ends, by its own answer or by an error.
template <class Work>
int ended(Work work) {
  using namespace waverig;
  try {
    return work();
  } catch (const UserError& error) {
    return fail(kBadInput, error.what());
  } catch (const NegativeAnswer& error) {
    return fail(kAnswerIsNo, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error);
  } catch (const cli::Interrupted& told) {
    std::signal(told.signal, SIG_DFL);
    return std::raise(told.signal);
  } catch (const std::exception& error) {
    return fail(kAnswerIsNo, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace waverig;
  cli::hold_standard_streams();
  CLI::App app{"waverig: how well does a low-cost sensor, with its estimator, measure waves?"};
  app.set_version_flag("--version", std::string("waverig ") + kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  cli::Command chosen;
  for (const auto add : cli::kCommands) add(app, chosen);
  app.footer(  // last, or each command without one of its own would end with it
      "Examples:\n"
      "  waverig sweep rig/default.toml --out results/table2      plan, run, evaluate, draw\n"
      "  waverig plan rig/default.toml                            what would run, and what cannot\n"
      "  waverig estimate recording.csv.gz --out results/mine     heave and waves of a recording\n"
      "Each command explains itself with --help.");

  return ended([&] {
    int status = kDone;
    try {
      refuse_unknown_command(app, argc, argv);
      app.parse(argc, argv);
      status = chosen();
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) return fail(kBadInput, error.what());
      status = app.exit(error);  // --help, --version
    }
    cli::finish_stdout();
    return status;
  });
}
