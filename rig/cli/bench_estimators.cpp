// waverig bench-estimators: every method on the same seas and regular waves, from the simulated sensor unit,
// as a table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "rig/campaign/coverage.h"
#include "rig/campaign/sweep.h"
#include "rig/cli/commands.h"
#include "rig/cli/estimator_bench.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/recording.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;

struct BenchEstimatorsArguments {
  std::string out;
  std::uint64_t seed = 1;
  int seeds = 0;  // 0: one, in full three
  int rigs = -1;  // -1: none, in full 200
  bool full = false;
};

struct Row {
  BenchCase settings;
  std::string method;
  int records = 0;
  BenchFigures figures;
  BenchLimits limits;
};

constexpr const char* name_of(BenchMotion motion) {
  switch (motion) {
    case BenchMotion::kRegular:
      return "regular";
    case BenchMotion::kJonswap:
      return "jonswap";
    case BenchMotion::kPiersonMoskowitz:
      return "pierson-moskowitz";
  }
  return "";
}

// Seas no steeper than seas are; regular waves as a rig makes them.
std::vector<BenchCase> cases(bool full) {
  constexpr double kFewestWaves = 80;  // scatter over its bound within 8 %
  std::vector<BenchCase> all;
  const auto add = [&](BenchMotion motion, double duration_s,
                       std::initializer_list<std::pair<double, double>> settings) {
    for (const auto& [period_s, height_m] : settings)
      all.push_back({motion, period_s, height_m, std::max(duration_s, kFewestWaves * period_s)});
  };
  constexpr double kSea_s = 1200, kRegular_s = 300;
  if (!full) {
    add(BenchMotion::kJonswap, kSea_s, {{3, 0.5}, {6, 1}, {8, 1.5}, {12, 1}});
    add(BenchMotion::kRegular, kRegular_s, {{6, 1}, {12, 1}});
    return all;
  }
  add(BenchMotion::kJonswap, kSea_s,
      {{3, 0.5},
       {4, 0.5},
       {6, 0.5},
       {6, 1},
       {6, 2},
       {8, 0.5},
       {8, 1.5},
       {8, 4},
       {9, 1},
       {9, 2},
       {9, 4},
       {12, 0.5},
       {12, 1},
       {12, 4}});
  add(BenchMotion::kPiersonMoskowitz, kSea_s, {{3, 0.5}, {6, 1}, {8, 1.5}, {9, 2}, {12, 1}, {12, 4}});
  add(BenchMotion::kRegular, kRegular_s,
      {{2, 0.3},
       {3, 0.3},
       {4, 0.6},
       {6, 0.6},
       {6, 1},
       {8, 1},
       {12, 0.6},
       {12, 1},
       {12, 3},
       {16, 1},
       {20, 1},
       {20, 3}});
  return all;
}

std::vector<BenchMethod> methods_for(BenchMotion motion) {
  // lee2014 tells the trace of its eq. (10), drift and all; what it corrects are its waves.
  if (motion == BenchMotion::kRegular)
    return {{"harmonic"}, {.name = "lee2014", .tells_heave = false}, {"realtime"}};
  return {{"realtime"}, {"realtime", 0.5}, {"realtime", 2}, {"smoothed"}, {"spectral"}};
}

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "";
}

constexpr const char* kColumns =
    "sea,period_s,height_cm,method,records,rms_percent,settled_rms_percent,hm0_error_percent,tm02_error_"
    "percent,"
    "mean_height_error_percent,std_over_bound,gain,lag_s,us_a_sample,rms_bound_percent,settled_rms_bound_"
    "percent\n";

std::string csv(const std::vector<Row>& rows) {
  std::string text = kColumns;
  for (const auto& [settings, method, records, f, limits] : rows)
    text += fmt::format("{},{:g},{:g},\"{}\",{},{},{},{},{},{},{},{},{},{},{},{}\n", name_of(settings.motion),
                        settings.period_s, 100 * settings.height_m, method, records, cell(f.rms, 4),
                        cell(f.settled_rms, 4), cell(f.hm0_error, 4), cell(f.tm02_error, 4),
                        cell(f.mean_height_error, 4), cell(f.std_over_bound, 3), cell(f.gain, 4),
                        cell(f.lag_s, 4), cell(f.us_a_sample, 3), cell(limits.rms, 4),
                        cell(limits.settled_rms, 4));
  return text;
}

std::string transfer_csv(const std::vector<Row>& rows) {
  std::string text = "sea,period_s,height_cm,method,f_hz,gain,lag_s,error_percent\n";
  for (const Row& row : rows)
    for (const evaluation::TransferPoint& p : row.figures.transfer)
      text += fmt::format("{},{:g},{:g},\"{}\",{:.4f},{},{},{}\n", name_of(row.settings.motion),
                          row.settings.period_s, 100 * row.settings.height_m, row.method, p.f_hz,
                          cell(p.gain, 4), cell(p.lag_s, 4), cell(100 * p.error_ratio, 2));
  return text;
}

constexpr const char* kLine =
    "{:<18} {:>6} {:>6}  {:<20} {:>6} {:>6} {:>7} {:>6} {:>7} {:>7} {:>7} {:>6} {:>6} {:>7} {:>6}\n";

std::string heading() {
  return fmt::format(kLine, "sea", "T, Tp", "H, Hm0", "method", "RMS", "bound", "RMS", "bound", "Hm0", "Tm02",
                     "mean H", "std /", "gain", "lag", "us a") +
         fmt::format(kLine, "", "s", "cm", "", "all, %", "%", "5 min+", "%", "err, %", "err, %", "err, %",
                     "bound", "", "s", "sample");
}

std::string line(const Row& row) {
  const BenchFigures& f = row.figures;
  return fmt::format(kLine, name_of(row.settings.motion), fmt::format("{:g}", row.settings.period_s),
                     fmt::format("{:g}", 100 * row.settings.height_m), row.method, cell(f.rms, 2),
                     cell(row.limits.rms, 2), cell(f.settled_rms, 2), cell(row.limits.settled_rms, 2),
                     cell(f.hm0_error, 2), cell(f.tm02_error, 2), cell(f.mean_height_error, 2),
                     cell(f.std_over_bound, 2), cell(f.gain, 3), cell(f.lag_s, 3), cell(f.us_a_sample, 2));
}

// How often the truth lies inside the stated interval, and the budget against what is observed.
void cover(const BenchEstimatorsArguments& arguments, int rigs) {
  constexpr double kRun_s = 120;
  const auto cells = rig::coverage(arguments.seed, rigs, {{4, 1}, {12, 1}}, kRun_s, "harmonic");
  std::string text =
      "method,period_s,height_cm,rigs,inside_percent,mean_error_percent,rms_error_percent,predicted_"
      "percent\n";
  fmt::print("\nmean heights of {} simulated rigs, a unit, calibration and noise each\n", rigs);
  for (const rig::Coverage& c : cells) {
    const double inside = 100.0 * c.inside / c.rigs;
    fmt::print(
        "{}, {:g} s, {:g} cm: inside the expanded interval {:.1f} %; error {:+.3f} % on average, {:.3f} % "
        "rms, "
        "{:.3f} % predicted\n",
        c.method, c.setting.period_s, 100 * c.setting.height_m, inside, 100 * c.mean_error, 100 * c.rms_error,
        100 * c.predicted);
    text += fmt::format("{},{:g},{:g},{},{:.2f},{:.4f},{:.4f},{:.4f}\n", c.method, c.setting.period_s,
                        100 * c.setting.height_m, c.rigs, inside, 100 * c.mean_error, 100 * c.rms_error,
                        100 * c.predicted);
  }
  if (!arguments.out.empty()) write_atomically(fs::path(arguments.out) / "coverage.csv", text);
}

int bench_estimators(const BenchEstimatorsArguments& arguments) {
  std::optional<rig::DirectoryLock> lock;
  if (!arguments.out.empty()) lock = hold_out_directory(arguments.out);
  const rig::CalibratedUnit calibrated = rig::calibrate(rig::read_campaign("", &arguments.seed).settings);
  const int records = arguments.seeds > 0 ? arguments.seeds : (arguments.full ? 3 : 1);
  fmt::print("{}", heading());
  std::vector<Row> rows;
  for (const BenchCase& settings : cases(arguments.full)) {
    const std::vector<BenchMethod> methods = methods_for(settings.motion);
    std::vector<std::vector<BenchFigures>> figures(methods.size());
    for (int k = 0; k < records; ++k) {
      const BenchRecord record =
          bench_record(settings, calibrated.unit,
                       derived_seed(arguments.seed, name_of(settings.motion), static_cast<std::uint64_t>(k)));
      for (std::size_t m = 0; m < methods.size(); ++m)
        figures[m].push_back(judge_method(methods[m], record, calibrated.unit));
    }
    const std::optional<evaluation::HeaveBound> bound = bound_of(settings, calibrated.unit);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      rows.push_back({settings, methods[m].title(), records, pooled(figures[m]),
                      bound ? limits(settings, methods[m], *bound) : BenchLimits{}});
      fmt::print("{}", line(rows.back()));
      std::fflush(stdout);
    }
  }
  if (!arguments.out.empty()) {
    write_atomically(fs::path(arguments.out) / "estimators.csv", csv(rows));
    write_atomically(fs::path(arguments.out) / "gain_and_lag.csv", transfer_csv(rows));
  }
  const int rigs = arguments.rigs >= 0 ? arguments.rigs : (arguments.full ? 200 : 0);
  if (rigs > 0) cover(arguments, rigs);
  return 0;
}

}  // namespace

void add_bench_estimators(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<BenchEstimatorsArguments>();
  CLI::App* command = app.add_subcommand(
      "bench-estimators",
      "Every method on the same simulated seas and waves: error, gain, lag and cost as a table");
  command->add_option("--out", arguments->out,
                      "Directory for estimators.csv, gain_and_lag.csv and coverage.csv");
  command->add_flag("--full", arguments->full,
                    "The whole grid, three records each, instead of a minute's choice");
  command->add_option("--seed", arguments->seed, "Of the sensor unit, the seas and the noise")
      ->check(seed())
      ->capture_default_str();
  command->add_option("--records", arguments->seeds, "Records of each sea; 1, with --full 3")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--rigs", arguments->rigs,
                   "Simulated rigs over which the stated uncertainty is tried; 0, with --full 200")
      ->check(CLI::Range(0, 100000));
  command->footer(
      "The sensor unit is the default campaign's, calibrated in six positions. A record begins in the midst\n"
      "of the sea. RMS: of heave, mean removed, of 4 standard deviations of the true heave; over the whole\n"
      "record, and from five minutes on, where gain and lag are told too. Its bound: the least RMS, in % of\n"
      "the set Hm0, with which heave can be told by the method's lag (realtime none or as named, the others\n"
      "the whole record) where the spectrum is known and nothing disturbs but the accelerometer's white\n"
      "noise and wandering bias (Wiener); of a record that begins with path and speed unknown. Hm0,\n"
      "Tm02 and mean height against those of the record itself; std over the Cramer-Rao bound of a single\n"
      "wave's height. Of lee2014 the waves alone: its trace is not corrected. Examples:\n"
      "  waverig bench-estimators\n"
      "  waverig bench-estimators --full --out results/estimators\n"
      "  waverig bench-estimators --rigs 200\n"
      "  waverig bench-estimators --seed 7 --records 5 --out results/estimators");
  command->callback([arguments, &chosen] { chosen = [arguments] { return bench_estimators(*arguments); }; });
}

}  // namespace waverig::cli
