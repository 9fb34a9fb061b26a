// waverig film: a recorded run as a film, the rig beside its live traces.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "estimator/evaluation/run_record.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "render/scene/film.h"
#include "rig/cli/commands.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/recording.h"
#include "rig/cli/signals.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;

struct FilmArguments {
  std::string log, out, method;
  render::FilmSettings film;
  bool light = false;
};

// The film under another name until it is whole.
struct Partial {
  fs::path path;
  ~Partial() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

int film(const FilmArguments& arguments) {
  refuse_to_overwrite(arguments.log, arguments.out);
  const fs::path out = led_to(arguments.out);
  if (fs::exists(out) && !fs::is_regular_file(out))
    throw UserError(fmt::format("--out {}: is {}; expected an MP4 file", arguments.out,
                                fs::is_directory(out) ? "a folder" : "no file that another could replace"));
  if (out.has_extension() && out.extension() != ".mp4")
    throw UserError(
        fmt::format("--out {}: the film is an MP4 file; expected a name that ends in .mp4", arguments.out));
  const evaluation::RunRecord run = evaluation::load_run(arguments.log);
  const render::RigMotion motion(run, arguments.method);
  render::FilmSettings settings = arguments.film;
  settings.theme = arguments.light ? render::Theme::kPrint : render::Theme::kDark;
  settings.provenance.version = kVersion;
  settings.provenance.command = fmt::format("waverig film {}", arguments.log);
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const Partial partial{fmt::format("{}.{}.partial", out.string(), ::getpid())};
  keep_signals();
  render::write_film(motion, settings, partial.path, [terminal](std::size_t done, std::size_t all) {
    end_if_told();
    if (terminal) fmt::print(stderr, "\r\033[K{} of {} frames", done, all);
  });
  rename_whole(partial.path, out);
  if (terminal) fmt::print(stderr, "\r\033[K");
  fmt::print("{}\n", arguments.out);
  return 0;
}

}  // namespace

void add_film(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<FilmArguments>();
  CLI::App* command = app.add_subcommand("film", "Make a film of a recorded run");
  command->add_option("log", arguments->log, "LCM event log of a run, e.g. results/table2/runs/….lcm")
      ->required();
  command->add_option("--out", arguments->out, "MP4 file (H.264)")->required();
  command->add_option("--method", arguments->method,
                      "Whose heave is shown; the one nearest to the truth by default");
  command
      ->add_option("--begin", arguments->film.begin_s,
                   "Seconds of the record; the steady part's start by default")
      ->check(finite());
  command->add_option("--seconds", arguments->film.duration_s, "Of the record; two periods by default")
      ->check(positive());
  command->add_option("--speed", arguments->film.speed, "Record seconds per film second")
      ->check(positive())
      ->capture_default_str();
  command->add_flag("--light", arguments->light, "On white instead of dark");
  command->footer(
      "Example:\n  waverig film results/table2/runs/T12.00s_H100.0cm_r1.lcm --out rig.mp4 --speed 2");
  command->callback([arguments, &chosen] { chosen = [arguments] { return film(*arguments); }; });
}

}  // namespace waverig::cli
