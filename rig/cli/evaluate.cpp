// waverig evaluate: judges the recorded runs of a campaign anew, or a heave series by itself or against a
// truth.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "estimator/evaluation/even_series.h"
#include "estimator/evaluation/heave_against_truth.h"
#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/heave_spectrum.h"
#include "estimator/evaluation/netcdf_file.h"
#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "estimator/evaluation/run_judge.h"
#include "estimator/evaluation/run_record.h"
#include "estimator/evaluation/summary.h"
#include "estimator/evaluation/waves_csv.h"
#include "estimator/evaluation/zero_crossing.h"
#include "estimator/method.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "rig/campaign/results_directory.h"
#include "rig/cli/commands.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/recording.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::string input, out, truth;
  std::vector<std::string> others;  // NAME=DIR
  evaluation::AgainstTruthSettings against;
  evaluation::ZeroCrossingSettings waves;
  bool netcdf = false;
  std::vector<const CLI::Option*> of_heave, of_campaign;  // options that only one kind of input knows
};

evaluation::HeaveComparison against_truth(const EvaluateArguments& arguments,
                                          const evaluation::HeaveSeries& heave) {
  const evaluation::HeaveSeries truth = evaluation::read_heave_csv(arguments.truth);
  try {
    return evaluation::compare_with_truth(heave, truth, arguments.against);
  } catch (const UserError& error) {
    throw UserError(fmt::format("{} against {}: {}", arguments.input, arguments.truth, error.what()));
  }
}

int evaluate_heave(const EvaluateArguments& arguments) {
  if (arguments.out.empty())
    throw UserError("--out is missing; expected a directory for waves.csv and summary.json");
  refuse_to_overwrite({arguments.input, arguments.truth}, arguments.out,
                      {"waves.csv", "summary.json", "record.nc"});
  const evaluation::HeaveSeries heave = evaluation::read_heave_csv(arguments.input);
  if (heave.utime.size() > 1)
    check_time_unit(arguments.input,
                    static_cast<double>(evaluation::median_interval(heave.utime)) * kMicrosecond);
  const auto counted =
      evaluation::count_waves(heave.utime, heave.heave_m, arguments.waves, heave.heave_sigma_m);
  const auto waves = evaluation::waves_of(counted);
  const evaluation::HeaveSpectrum spectrum = evaluation::spectrum_of(heave.utime, heave.heave_m);
  evaluation::Summary summary = evaluation::summary_of("zero-up-crossing", waves);
  evaluation::take_sea(summary, std::vector{evaluation::sea_of(spectrum)});
  if (!arguments.truth.empty()) {
    const auto comparison = against_truth(arguments, heave);
    summary.heave_rms_error_m = comparison.rmse_m();
    summary.heave_rms_error_percent = 100 * comparison.rmse_m() / (4 * comparison.true_std_m());
    summary.heave_gain = comparison.gain();
    summary.heave_lag_s = comparison.lag_s();
  }
  const rig::DirectoryLock lock = hold_out_directory(arguments.out);
  AtomicFile waves_file(fs::path(arguments.out) / "waves.csv"),
      summary_file(fs::path(arguments.out) / "summary.json");
  waves_file.write(evaluation::waves_csv(waves));
  waves_file.flush();
  summary_file.write(evaluation::to_json(summary));
  summary_file.flush();
  const fs::path record = fs::path(arguments.out) / "record.nc";
  if (arguments.netcdf)
    evaluation::write_netcdf(record, {heave, waves, spectrum, summary, std::string("waverig ") + kVersion,
                                      "Heave of " + arguments.input});
  // While an earlier summary is gone and the new one not there the folder is not finished.
  fs::remove(fs::path(arguments.out) / "summary.json");
  if (!arguments.netcdf) fs::remove(record);  // of that earlier call
  waves_file.commit();
  summary_file.commit();
  fmt::print("{}", evaluation::to_json(summary));
  return 0;
}

std::map<std::string, fs::path> other_methods(const std::vector<std::string>& others) {
  constexpr const char* kOfAName =  // as on the bus
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
  std::map<std::string, fs::path> methods;
  for (const std::string& other : others) {
    const std::size_t sign = other.find('=');
    std::error_code ignored;
    if (sign == std::string::npos || !fs::is_directory(other.substr(sign + 1), ignored))
      throw UserError(
          fmt::format("--heave {}: expected NAME=DIR, where DIR holds a heave CSV for each run", other));
    const std::string name = other.substr(0, sign);
    if (name.empty() || name.find_first_not_of(kOfAName) != std::string::npos)
      throw UserError(
          fmt::format("--heave {}: name '{}'; expected letters, digits, '_', '.' and '-'", other, name));
    if (!methods.emplace(name, other.substr(sign + 1)).second)
      throw UserError(fmt::format("--heave {}: '{}' is given twice; expected a name each", other, name));
  }
  return methods;
}

fs::path file_of(const fs::path& directory, const std::string& run) { return directory / (run + ".csv"); }

// What the figures of someone else's heave do not say by themselves.
void remark(const evaluation::RunResult& run, const fs::path& file) {
  if ((run.statistics.flags & flag::kGap) != 0)
    fmt::print(stderr,
               "waverig: {}: heave for {:.0f} % of the run's steady part; judged by its {} waves, flag gap\n",
               file.string(), 100 * run.heave_coverage, run.statistics.waves);
  if (std::cos(2 * std::numbers::pi * run.heave_lag_s / run.true_tm02_s) < 0)
    fmt::print(
        stderr,
        "waverig: {}: heave goes against the true one, {:.2f} s late in waves of {:.1f} s: is it upside "
        "down, or its clock off?\n",
        file.string(), run.heave_lag_s, run.true_tm02_s);
}

// Heave of someone else's program for this run joins those of the log.
void add_other_heave(evaluation::RunRecord& record, const std::string& method, const fs::path& directory) {
  if (record.heave.contains(method) || record.waves.contains(method) || record.seas.contains(method))
    throw UserError(fmt::format("--heave {}={}: run {} has a method of that name; expected another name",
                                method, directory.string(), record.run));
  const fs::path file = file_of(directory, record.run);
  const evaluation::HeaveSeries series = evaluation::read_heave_csv(file);
  bool any = false;
  for (std::size_t i = 0; i < series.utime.size(); ++i)
    any = any || (std::isfinite(series.heave_m[i]) && series.utime[i] >= record.steady_begin_utime &&
                  series.utime[i] < record.steady_end_utime);
  if (!any)
    throw UserError(
        fmt::format("{}: heave from {} to {}, none in the steady part of the run from {} to {}; expected the "
                    "run's clock, in "
                    "microseconds",
                    file.string(), series.utime.front(), series.utime.back(), record.steady_begin_utime,
                    record.steady_end_utime));
  auto& heave = record.heave[method];
  for (std::size_t i = 0; i < series.utime.size(); ++i) {
    estimator::HeaveSample sample;
    sample.utime = series.utime[i];
    sample.heave_m = series.heave_m[i];
    sample.heave_sigma_m = series.heave_sigma_m[i];
    heave.push_back(sample);
  }
}

// The sensor's rate and noise and the bounds of its sea, as far as log and earlier results tell them. What
// came as heave alone tells no waves, whatever its name.
evaluation::JudgeSettings judge_settings(const evaluation::RunRecord& record,
                                         const evaluation::CampaignResults& earlier,
                                         const std::map<std::string, fs::path>& others) {
  evaluation::JudgeSettings settings;
  settings.tells_waves = [&others](std::string_view method) {
    return !others.contains(std::string(method)) && estimator::tells_waves(method);
  };
  if (record.imu.size() > 1)
    settings.sample_rate_hz =
        static_cast<double>(record.imu.size() - 1) /
        (static_cast<double>(record.imu.back().utime - record.imu.front().utime) * kMicrosecond);
  for (const evaluation::RunResult& run : earlier.runs)
    if (run.run == record.run) {
      settings.motion = run.motion;
      settings.noise_density_mps2_rthz = run.noise_density_mps2_rthz;
      settings.heave_bound_m[run.method] = run.heave_bound_m;
    }
  return settings;
}

// Results are replaced by those of the logs: where a log has gone its run would go too.
void refuse_to_lose_a_run(const fs::path& directory, const evaluation::CampaignResults& results) {
  for (const evaluation::RunResult& run : results.runs)
    if (const fs::path log = evaluation::log_of(directory, run.run); !fs::exists(log))
      throw UserError(
          fmt::format("{}: is not there; expected the log of a run that the results hold", log.string()));
}

std::string command_of(const EvaluateArguments& arguments) {
  std::string command = "waverig evaluate " + arguments.input;
  for (const std::string& other : arguments.others) command += " --heave " + other;
  return arguments.out.empty() ? command : command + " --out " + arguments.out;
}

int evaluate_campaign(const EvaluateArguments& arguments) {
  const fs::path directory = arguments.input,
                 out = arguments.out.empty() ? directory : fs::path(arguments.out);
  const auto others = other_methods(arguments.others);
  evaluation::CampaignResults results = evaluation::read_results(directory);
  std::error_code error;  // of a folder that is not there or may not be read: no logs
  const bool elsewhere = !fs::equivalent(directory, out, error);
  if (elsewhere) rig::refuse_other_campaign(directory, out);
  std::vector<fs::path> logs;
  for (const auto& entry : fs::directory_iterator(evaluation::runs_of(directory), error))
    if (entry.path().extension() == ".lcm") logs.push_back(entry.path());
  if (logs.empty())
    throw UserError(fmt::format("{}: no runs/*.lcm; expected the logs of a campaign", arguments.input));
  std::sort(logs.begin(), logs.end());

  refuse_to_lose_a_run(directory, results);
  std::vector<evaluation::RunResult> judged;
  for (const fs::path& log : logs) {
    evaluation::RunRecord record = evaluation::load_run(log);
    for (const auto& [name, heave] : others) add_other_heave(record, name, heave);
    auto runs = evaluation::judge(record, judge_settings(record, results, others));
    if (runs.empty())
      throw UserError(fmt::format("{}: no method to judge in it; expected the log of a run", log.string()));
    for (auto& run : runs) {
      if (const auto other = others.find(run.method); other != others.end())
        remark(run, file_of(other->second, run.run));
      judged.push_back(std::move(run));
    }
  }
  results.runs = std::move(judged);
  results.cells = evaluation::cells_of(results.runs);
  results.judged_version = kVersion;
  results.judged_command = command_of(arguments);
  const rig::DirectoryLock lock = hold_out_directory(out.string());
  if (elsewhere) rig::take_campaign(directory, out);
  evaluation::write_results(out, results);
  fmt::print("{}", evaluation::results_csv(results.cells));
  return 0;
}

int evaluate(const EvaluateArguments& arguments) {
  std::error_code ignored;  // what may not be looked at is refused where it is opened
  const bool campaign = fs::is_directory(arguments.input, ignored);
  for (const CLI::Option* option : campaign ? arguments.of_heave : arguments.of_campaign)
    if (option->count() > 0)
      throw UserError(fmt::format("{}: {} is {} directory; expected {}", option->get_name(), arguments.input,
                                  campaign ? "a" : "no",
                                  campaign ? "a heave CSV with it" : "a results directory with it"));
  return campaign ? evaluate_campaign(arguments) : evaluate_heave(arguments);
}

}  // namespace

void add_evaluate(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "Judge a campaign's logs anew, or a heave series");
  command
      ->add_option("input", arguments->input,
                   "Results directory, or heave CSV (utime,heave_m[,heave_sigma_m]), plain or .gz")
      ->required();
  command->add_option("--out", arguments->out, "Directory to write into; of a campaign its own by default");
  arguments->of_campaign = {
      command
          ->add_option("--heave", arguments->others,
                       "NAME=DIR: judge another program too, its heave of each run in DIR/<run>.csv")
          ->allow_extra_args(false)};
  CLI::Option* truth = command->add_option(
      "--truth", arguments->truth, "Heave CSV to hold the heave against; column 'moving' selects where");
  arguments->of_heave = {
      truth,
      command
          ->add_option("--high-pass-hz", arguments->against.high_pass_hz,
                       "Compare above this frequency only (zero phase)")
          ->check(not_negative())
          ->needs(truth),
      command->add_option("--zero-line-m", arguments->waves.level_m, "Zero line of the waves, above the mean")
          ->check(finite()),
      command->add_flag("--detrend", arguments->waves.remove_trend,
                        "Zero line is the straight line of least squares"),
      command
          ->add_option("--dead-band-m", arguments->waves.dead_band_m,
                       "A crossing counts once the heave has left this band")
          ->check(not_negative()),
      command->add_flag("--netcdf", arguments->netcdf,
                        "Write heave, waves and spectrum as record.nc (CF) too")};
  command->footer(
      "Examples:\n"
      "  waverig evaluate results/table2\n"
      "  waverig evaluate results/table2 --heave theirs=their/heave --out results/side-by-side\n"
      "  waverig evaluate buoy.heave.csv --out results/buoy\n"
      "  waverig evaluate results/mine/heave.csv --truth cameras.csv.gz --high-pass-hz 0.12 --out "
      "results/judged");
  command->callback([arguments, &chosen] { chosen = [arguments] { return evaluate(*arguments); }; });
}

}  // namespace waverig::cli
