// waverig analyse compass: reruns the simulation of Cho, section III.4, and holds it against the published
// figures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "estimator/compass/tilt_study.h"
#include "lcmtypes/atomic_file.h"
#include "render/figure_writer.h"
#include "rig/campaign/results_directory.h"
#include "rig/cli/commands.h"
#include "rig/cli/compass_figures.h"
#include "rig/cli/number_checks.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

struct CompassArguments {
  estimator::TiltStudySettings study;
  std::string out;
  bool replace = false;
};

std::string number(double value) { return fmt::format("{:.4f}", value); }
std::string interval(const estimator::Interval& i) { return fmt::format("{:.4f} … {:.4f}", i.low, i.high); }

std::string table(const estimator::TiltStudy& study) {
  constexpr const char* kRow = "{:<50} {:>4} {:>9}  {:>20} {:>11}  {:>20}  {}\n";
  std::string text = fmt::format(kRow, "", "", "", "95 % of repeats", "", "95 %", "published");
  text += fmt::format(kRow, "", "unit", "published", "of 100 runs",
                      fmt::format("{} runs", study.settings.runs), "confidence", "in repeats");
  for (const auto& f : study.figures)
    text += fmt::format(kRow, f.name, f.unit, number(f.published), interval(f.repeats), number(f.value),
                        interval(f.confidence), f.repeats.contains(f.published) ? "yes" : "NO");
  return text;
}

std::string csv(const estimator::TiltStudy& study) {
  std::string text =
      "figure,unit,published,repeats_low,repeats_high,value,confidence_low,confidence_high,published_within_"
      "repeats\n";
  for (const auto& f : study.figures)
    text += fmt::format("\"{}\",{},{},{},{},{},{},{},{}\n", f.name, f.unit, f.published, f.repeats.low,
                        f.repeats.high, f.value, f.confidence.low, f.confidence.high,
                        f.repeats.contains(f.published) ? 1 : 0);
  return text;
}

std::string border_csv(const std::vector<BorderPoint>& border) {
  std::string text =
      "tilt_deg,roll_linear_of_g,roll_second_of_g,pitch_linear_of_g,pitch_second_of_g,heading_linear_of_g,"
      "heading_second_of_g\n";
  for (const BorderPoint& p : border)
    text += fmt::format("{:.0f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", p.tilt_rad / kDegree,
                        p.first_of_g[0], p.second_of_g[0], p.first_of_g[1], p.second_of_g[1], p.first_of_g[2],
                        p.second_of_g[2]);
  return text;
}

int analyse_compass(const CompassArguments& arguments) {
  const std::string command =
      fmt::format("waverig analyse compass --runs {} --seed {}", arguments.study.runs, arguments.study.seed);
  using Mode = rig::ResultsDirectory::Mode;
  rig::ResultsDirectory directory(arguments.out, arguments.replace ? Mode::kReplace : Mode::kFresh,
                                  /*resumes=*/false);
  const estimator::TiltStudy study = estimator::run_tilt_study(arguments.study);
  const std::vector<BorderPoint> border = border_of(arguments.study);

  write_atomically(directory.working() / "settings.toml",
                   fmt::format("command = \"{}\"\nversion = \"{}\"\nruns = {}\nseed = {}\n", command,
                               kVersion, arguments.study.runs, arguments.study.seed));
  write_atomically(directory.working() / "compass.csv", csv(study));
  write_atomically(directory.working() / "border.csv", border_csv(border));
  std::filesystem::create_directories(directory.figures());
  render::Canvas canvas;
  const render::Provenance provenance{kVersion, command, std::to_string(arguments.study.seed)};
  for (const NamedFigure& named : compass_figures(study, border))
    render::save_png(named.figure, canvas, directory.figures() / (named.file + ".png"), provenance);
  std::filesystem::remove(directory.runs());  // nothing was recorded
  directory.finish();

  fmt::print("{}\nA largest error and the figures of one run are means over repeats.\nResults: {}\n",
             table(study), arguments.out);
  return 0;
}

}  // namespace

void add_analyse(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CompassArguments>();
  CLI::App* command =
      app.add_subcommand("analyse", "Rerun a published analysis and hold it against its figures");
  command->require_subcommand(1);
  CLI::App* compass = command->add_subcommand(
      "compass", "Tilt-compensated compass: how accelerometer errors reach the heading");
  compass->add_option("--out", arguments->out, "Results directory, made anew")->required();
  compass->add_option("--runs", arguments->study.runs, "Simulated runs; the document has 100")
      ->check(CLI::Range(2, 100000000))
      ->capture_default_str();
  compass->add_option("--seed", arguments->study.seed, "Of the random numbers")
      ->check(seed())
      ->capture_default_str();
  compass
      ->add_option("--jobs", arguments->study.threads,
                   "Threads, 0 for all cores; the results do not depend on it")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  compass->add_flag("--replace", arguments->replace,
                    "Replace results that are there, once the new ones are whole");
  compass->footer("Example:\n  waverig analyse compass --runs 100000 --out results/compass");
  command->footer("Example:\n  waverig analyse compass --out results/compass");
  compass->callback([arguments, &chosen] { chosen = [arguments] { return analyse_compass(*arguments); }; });
}

}  // namespace waverig::cli
