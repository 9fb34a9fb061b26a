// waverig estimate: heave and waves of a recording, by one method.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "estimator/calibration/accelerometer_calibration.h"
#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/heave_spectrum.h"
#include "estimator/evaluation/netcdf_file.h"
#include "estimator/evaluation/summary.h"
#include "estimator/evaluation/waves_csv.h"
#include "estimator/evaluation/zero_crossing.h"
#include "estimator/method.h"
#include "estimator/sample_guard.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "rig/campaign/sensor_unit.h"
#include "rig/cli/commands.h"
#include "rig/cli/digest.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/recording.h"
#include "rig/cli/signals.h"
#include "rig/cli/turning.h"
#include "rig/nodes/sample_watch.h"
#include "rig/version.h"

namespace waverig::cli {
namespace {

namespace fs = std::filesystem;
using estimator::ImuSample;

struct EstimateArguments {
  std::string input, out, method, calibration;
  bool netcdf = false;
  double rest_s = 0, lag_s = 0;
  double gravity_mps2 = kStandardGravity;
  double declination_deg = 0;
};

// The unit rests at the start of the record: what the gyroscope reads there is its bias. One reading that is
// none, or one bad time stamp, must not spoil the mean of all; that the accelerometer does not change is no
// fault of a unit at rest.
SampleSource without_gyro_bias(SampleSource source, double rest_s, const fs::path& path) {
  auto rest = std::make_shared<std::vector<ImuSample>>();
  estimator::SampleGuard guard({.flat_line_s = 0});
  Vector3d sum = Vector3d::Zero();
  std::int64_t usable = 0, begin_utime = 0;
  double rested_s = 0;
  ImuSample sample;
  while (rested_s < rest_s && source(sample)) {
    rest->push_back(sample);
    if (!guard.check(sample).usable) continue;
    if (usable++ == 0) begin_utime = sample.utime;
    rested_s = static_cast<double>(sample.utime - begin_utime) * kMicrosecond;
    sum += sample.w_NB_B;
  }
  if (rested_s < rest_s)
    throw UserError(fmt::format("{}: usable samples for {:.1f} s; expected more than --rest-seconds {:g}",
                                path.string(), rested_s, rest_s));
  const Vector3d bias_radps = sum / static_cast<double>(usable);
  return [source = std::move(source), rest, bias_radps, next = std::size_t{0}](ImuSample& out) mutable {
    if (next < rest->size())
      out = (*rest)[next++];
    else if (!source(out))
      return false;
    out.w_NB_B -= bias_radps;
    return true;
  };
}

// Lee 2014, eq. (16), and the gyroscope's offset.
SampleSource calibrated(SampleSource source, const estimator::SensorCalibration& calibration) {
  return [source = std::move(source), correct = estimator::AccelerometerCorrection(calibration.accelerometer),
          offset_radps = calibration.gyroscope.offset_radps](ImuSample& sample) {
    if (!source(sample)) return false;
    sample.f_B = correct(sample.f_B);
    sample.w_NB_B -= offset_radps;
    sample.flags &= ~flag::kUncalibrated;
    return true;
  };
}

// Keeps what a method tells and writes its heave as it comes.
class Collector : public estimator::Output {
 public:
  explicit Collector(const fs::path& heave_csv) : writer_(heave_csv) {}
  void heave(const estimator::HeaveSample& sample) override {
    end_if_told();
    writer_.write(sample);
    series_.utime.push_back(sample.utime);
    series_.heave_m.push_back(sample.heave_m);
    series_.heave_sigma_m.push_back(sample.heave_sigma_m);
    flags_ |= sample.flags & ~flag::kSettling & ~flag::kNoMagnetometer;
  }
  void wave(const estimator::Wave& wave) override { waves_.push_back(wave); }
  void sea(const estimator::SeaState& sea) override { seas_.push_back(sea); }
  void offset_change(const estimator::OffsetChange& change) override { offset_changes_.push_back(change); }

  void flush() { writer_.flush(); }
  void close() { writer_.close(); }
  // The method's own waves; of a method that tells none, the zero-up-crossing waves of its heave.
  std::vector<estimator::Wave> waves(const std::string& method) const {
    if (estimator::tells_waves(method)) return waves_;
    return evaluation::waves_of(evaluation::count_waves(
        series_.utime, series_.heave_m, {.interpolate_extremes = true}, series_.heave_sigma_m));
  }
  const evaluation::HeaveSeries& heave_series() const { return series_; }
  const std::vector<estimator::SeaState>& seas() const { return seas_; }
  const std::vector<estimator::OffsetChange>& offset_changes() const { return offset_changes_; }
  std::int32_t flags() const { return flags_; }

 private:
  evaluation::HeaveCsvWriter writer_;
  evaluation::HeaveSeries series_;
  std::vector<estimator::Wave> waves_;
  std::vector<estimator::SeaState> seas_;
  std::vector<estimator::OffsetChange> offset_changes_;
  std::int32_t flags_ = 0;
};

// Methods that know the sea state and direction, where the chosen one does not: their heave and waves are not
// asked for.
class SeaStates : public estimator::Output {
 public:
  SeaStates(const std::string& chosen, estimator::MethodSettings settings) {
    settings.fixed_lag_s = 0;  // the chosen one's
    for (const std::string& name : estimator::method_names())
      if (name != chosen && (name == "spectral" || name == "directional"))
        methods_.push_back(estimator::make_method(name, settings));
  }
  void sea(const estimator::SeaState& sea) override { seas_.push_back(sea); }
  void add(const ImuSample& sample) {
    for (const auto& method : methods_) method->add(sample, *this);
  }
  std::vector<estimator::SeaState> finish() {
    for (const auto& method : methods_) method->finish(*this);
    return seas_;
  }

 private:
  std::vector<std::unique_ptr<estimator::Method>> methods_;
  std::vector<estimator::SeaState> seas_;
};

// What went by of the record.
struct Record {
  rig::SampleWatch watch;
  Turning turning;  // of the samples that are used
  std::int64_t begin_utime = 0, end_utime = 0;
  struct Mean {
    double sum = 0;
    std::int64_t count = 0;
    double value() const { return sum / static_cast<double>(count); }
  } used_mps2, left_out_mps2;  // specific force, of those that have one

  void add(const ImuSample& sample) {
    if (watch.samples() == 0) begin_utime = sample.utime;
    const std::int64_t left_out = watch.left_out();
    watch.add(sample);
    end_utime = sample.utime;
    if (!sample.f_B.allFinite()) return;
    const bool used = watch.left_out() == left_out;
    if (used) turning.add(sample);
    Mean& mean = used ? used_mps2 : left_out_mps2;
    mean.sum += sample.f_B.norm();
    ++mean.count;
  }
};

// The figures, by whom those of the sea state are, and what all was made of.
std::string summary_json(const evaluation::Summary& summary, const EstimateArguments& arguments,
                         const Record& record, const std::vector<estimator::OffsetChange>& offset_changes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(evaluation::to_json(summary));
  if (std::isfinite(summary.hm0_m))
    json["sea_state_method"] = std::isfinite(summary.tm02_s) ? "spectral" : "directional";
  for (const estimator::OffsetChange& change : offset_changes)
    json["offset_changes"].push_back(
        {{"utime", change.utime}, {"sigma_s", change.sigma_s}, {"mps2", change.mps2}});
  nlohmann::ordered_json& made_of = json["provenance"];
  made_of["version"] = kVersion;
  const auto put_file = [&](const std::string& key, const std::string& path) {
    if (path.empty()) return;
    made_of[key] = path;
    if (const std::string digest = sha256_of(path); !digest.empty()) made_of[key + "_sha256"] = digest;
  };
  put_file("input", arguments.input);
  put_file("calibration", arguments.calibration);
  made_of["gravity_mps2"] = arguments.gravity_mps2;
  made_of["declination_deg"] = arguments.declination_deg;
  made_of["rest_s"] = arguments.rest_s;
  if (arguments.lag_s > 0) made_of["lag_s"] = arguments.lag_s;
  made_of["samples"] = record.watch.samples();
  made_of["samples_left_out"] = record.watch.left_out();
  made_of["begin_utime"] = record.begin_utime;
  made_of["end_utime"] = record.end_utime;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void check_units(const Record& record, const EstimateArguments& arguments) {
  const Record::Mean& mean_mps2 = record.used_mps2.count > 0 ? record.used_mps2 : record.left_out_mps2;
  const double mean_force_mps2 = mean_mps2.value();
  if (std::abs(mean_force_mps2 - arguments.gravity_mps2) > 0.4 * arguments.gravity_mps2)
    throw UserError(
        fmt::format("{}: the mean specific force is {:.3f}; expected about {:.2f} (m/s^2, gravity included)",
                    arguments.input, mean_force_mps2, arguments.gravity_mps2));
  if (record.watch.left_out() == record.watch.samples())
    throw UserError(fmt::format("{}: {}; expected samples in m/s^2 and rad/s, nothing is told from these",
                                arguments.input, record.watch.words()));
  if (record.turning.contradicts_itself())
    throw UserError(fmt::format(
        "{}: by its gyroscope the unit turns at {:.1f} rad/s (rms), by its accelerometer at {:.2f}; expected "
        "rates in rad/s about the accelerometer's axes (are they in degrees?)",
        arguments.input, record.turning.told_radps(), record.turning.seen_radps()));
}

int estimate(const EstimateArguments& arguments) {
  refuse_to_overwrite({arguments.input, arguments.calibration}, arguments.out,
                      {"heave.csv", "waves.csv", "summary.json", "record.nc"});
  SampleSource source =
      arguments.calibration.empty() ? samples_of(arguments.input) : uncalibrated_samples_of(arguments.input);
  estimator::MethodSettings settings;
  settings.sensor.gravity_mps2 = arguments.gravity_mps2;
  settings.fixed_lag_s = arguments.lag_s;
  settings.compass.declination_rad = arguments.declination_deg * kDegree;
  if (!arguments.calibration.empty()) {
    const auto calibration = estimator::load_calibration(arguments.calibration);
    source = calibrated(std::move(source), calibration);
    rig::CampaignSettings campaign;  // what no calibration tells, as the default campaign's sensor has it
    campaign.estimator = settings;
    settings.sensor = rig::sensor_knowledge(campaign, calibration);
    if (calibration.compass) settings.compass.calibration = calibration.compass->correction;
  }
  if (arguments.rest_s > 0) source = without_gyro_bias(std::move(source), arguments.rest_s, arguments.input);
  const auto method = estimator::make_method(arguments.method, settings);

  const fs::path out = arguments.out;
  const rig::DirectoryLock lock = hold_out_directory(arguments.out);
  keep_signals();
  Collector collector(out / "heave.csv");
  SeaStates sea_states(arguments.method, settings);
  ImuSample sample;
  Record record;
  while (source(sample)) {
    end_if_told();
    record.add(sample);
    method->add(sample, collector);
    sea_states.add(sample);
  }
  method->finish(collector);
  check_time_unit(arguments.input, record.watch.usual_interval_s());
  check_units(record, arguments);

  const std::vector<estimator::Wave> waves = collector.waves(arguments.method);
  evaluation::Summary summary = evaluation::summary_of(arguments.method, waves);
  summary.flags |= collector.flags();
  std::vector<estimator::SeaState> seas = sea_states.finish();
  seas.insert(seas.end(), collector.seas().begin(), collector.seas().end());
  evaluation::take_sea(summary, seas);
  const std::string json = summary_json(summary, arguments, record, collector.offset_changes());
  end_if_told();
  AtomicFile waves_file(out / "waves.csv"), summary_file(out / "summary.json");
  waves_file.write(evaluation::waves_csv(waves));
  summary_file.write(json);
  collector.flush();
  waves_file.flush();
  summary_file.flush();
  if (arguments.netcdf) {
    const evaluation::HeaveSeries& heave = collector.heave_series();
    const evaluation::HeaveSpectrum spectrum = evaluation::spectrum_of(heave.utime, heave.heave_m);
    evaluation::write_netcdf(
        out / "record.nc",
        {heave, waves, spectrum, summary, std::string("waverig ") + kVersion, "Heave of " + arguments.input});
  }
  // What an earlier call left has stood until now. Its summary goes first and the new one comes last: while
  // it is missing the folder is not finished.
  fs::remove(out / "summary.json");
  if (!arguments.netcdf) fs::remove(out / "record.nc");  // of that earlier call
  collector.close();
  waves_file.commit();
  summary_file.commit();
  if (const std::string words = record.watch.words(); !words.empty())
    fmt::print(stderr, "waverig: {}: {}\n", arguments.input, words);
  for (const estimator::OffsetChange& change : collector.offset_changes())
    fmt::print(stderr,
               "waverig: {}: {:.1f} s after the first sample the vertical offset changed by {:+.3f} m/s^2: "
               "taken off\n",
               arguments.input, static_cast<double>(change.utime - record.begin_utime) * kMicrosecond,
               change.mps2);
  fmt::print("{}", json);
  return 0;
}

}  // namespace

void add_estimate(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<EstimateArguments>();
  const auto names = estimator::method_names();
  const auto known_method = [names](const std::string& name) {
    if (std::ranges::find(names, name) != names.end()) return std::string();
    return fmt::format("{}: expected one of {}", name, fmt::join(names, ", "));
  };
  const bool smooths = std::find(names.begin(), names.end(), "smoothed") != names.end();
  arguments->method = smooths ? "smoothed" : "harmonic";
  CLI::App* command =
      app.add_subcommand("estimate", "Heave and waves of a recording: heave.csv, waves.csv, summary.json");
  command->add_option("input", arguments->input, "Recording: an LCM event log, or a sample CSV, plain or .gz")
      ->required();
  command->add_option("--out", arguments->out, "Directory to write into")->required();
  command->add_option("--method", arguments->method, fmt::format("Method: {}", fmt::join(names, ", ")))
      ->check(known_method)
      ->capture_default_str();
  command->add_option(
      "--calibration", arguments->calibration,
      "Calibration file (waverig calibrate): corrects the samples, which are taken as calibrated without it, "
      "and says how uncertain that leaves them; what no calibration sees is as the default campaign's sensor "
      "has it");
  command
      ->add_option("--rest-seconds", arguments->rest_s,
                   "The unit rests so long at the start: take the gyroscope's bias there")
      ->check(not_negative());
  command
      ->add_option("--lag-s", arguments->lag_s,
                   "realtime: tell heave so much later, by what came meanwhile, as on a buoy that may wait")
      ->check(not_negative());
  command->add_option("--gravity", arguments->gravity_mps2, "Local gravity, m/s^2")
      ->check(between(9.7, 9.9))
      ->capture_default_str();
  command
      ->add_option("--declination", arguments->declination_deg,
                   "True less magnetic north, degrees, east positive")
      ->check(between(-180.0, 180.0));
  command->add_flag("--netcdf", arguments->netcdf, "Write heave, waves and spectrum as record.nc (CF) too");
  command->footer(
      "The sample CSV has the header utime,ax,ay,az,gx,gy,gz[,mx,my,mz][,temperature]: microseconds, m/s^2, "
      "rad/s;\n"
      "body axes forward, right, down; level at rest az = -g.\n"
      "Waves are the method's; Hm0, Tm and Tp those of spectral, directions those of directional, whichever\n"
      "the method (sea_state_method in summary.json).\n"
      "Examples:\n"
      "  waverig estimate recording.csv.gz --out results/mine --rest-seconds 5\n"
      "  waverig estimate recording.csv.gz --calibration unit7.json --out results/mine\n"
      "  waverig estimate recording.csv.gz --method realtime --lag-s 2 --out results/late\n"
      "  waverig estimate results/table2/runs/T12.00s_H100.0cm_r1.lcm --gravity 9.7986 --out results/again "
      "--method lee2014\n"
      "lee2014 needs gravity to 1 mm/s^2; a campaign's is that of the [place] in its campaign.toml.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return estimate(*arguments); }; });
}

}  // namespace waverig::cli
