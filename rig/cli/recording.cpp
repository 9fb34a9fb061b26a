#include "rig/cli/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/sample_csv.h"
#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "lcmtypes/event_log.h"
#include "lcmtypes/flags.h"
#include "rig/campaign/settings.h"

namespace waverig::cli {

namespace fs = std::filesystem;
using estimator::ImuSample;

namespace {

bool is_event_log(const fs::path& path) {
  constexpr unsigned char kSync[] = {0xED, 0xA1, 0xDA, 0x01};
  unsigned char head[4] = {};
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    const bool read = std::fread(head, 1, sizeof head, file) == sizeof head;
    std::fclose(file);
    if (read && std::equal(std::begin(head), std::end(head), std::begin(kSync))) return true;
  }
  return path.extension() == ".lcm";
}

SampleSource samples_of_log(const fs::path& path) {
  auto reader = std::make_shared<EventLogReader>(path);
  auto event = std::make_shared<LogEvent>();
  return [reader, event, path, any = false](ImuSample& sample) mutable {
    while (reader->next(*event)) {
      if (event->channel != channel::kImu) continue;
      imu_t message{};
      if (!event->decode(message))
        throw UserError(fmt::format("{}: channel {}, time {}: {} bytes of another type; expected imu_t",
                                    path.string(), event->channel, event->utime, event->data.size()));
      sample = estimator::sample_of(message);
      return any = true;
    }
    if (!any)
      throw UserError(
          fmt::format("{}: no samples; expected imu_t on channel {}", path.string(), channel::kImu));
    return false;
  };
}

}  // namespace

SampleSource samples_of(const fs::path& path) {
  if (is_event_log(path)) return samples_of_log(path);
  auto reader = std::make_shared<evaluation::SampleCsvReader>(path);
  return [reader](ImuSample& sample) { return reader->next(sample); };
}

SampleSource uncalibrated_samples_of(const fs::path& path) {
  SampleSource source = samples_of(path);
  if (!is_event_log(path)) return source;
  return [source = std::move(source), path](ImuSample& sample) {
    if (!source(sample)) return false;
    if ((sample.flags & flag::kUncalibrated) == 0)
      throw UserError(fmt::format(
          "{}: channel {}, time {}: the sample is calibrated already; expected samples flagged as "
          "uncalibrated, to be calibrated once",
          path.string(), channel::kImu, sample.utime));
    return true;
  };
}

void check_time_unit(const std::string& file, double usual_interval_s) {
  constexpr double kShortest_s = 6e-4, kLongest_s = 2;  // milliseconds of 2 Hz and more are seen
  if (usual_interval_s > 0 && (usual_interval_s < kShortest_s || usual_interval_s > kLongest_s))
    throw UserError(
        fmt::format("{}: column utime: by its times a row every {:g} s; expected microseconds, a row every "
                    "{:g} to {:g} s",
                    file, usual_interval_s, kShortest_s, kLongest_s));
}

void refuse_to_overwrite(const fs::path& recording, const fs::path& out) {
  std::error_code ignored;  // of an output that is not there
  if (fs::equivalent(recording, out, ignored))
    throw UserError(fmt::format("--out {}: is the recording itself; expected another file", out.string()));
}

void refuse_to_overwrite(const std::vector<std::string>& inputs, const fs::path& out,
                         const std::vector<std::string>& results) {
  std::error_code ignored;
  for (const std::string& input : inputs)
    for (const std::string& result : results)
      if (!input.empty() && fs::equivalent(input, out / result, ignored))
        throw UserError(fmt::format("--out {}: {} would take the place of {}; expected another directory",
                                    out.string(), (out / result).string(), input));
}

void refuse_to_overwrite_results(const std::string& option, const fs::path& file,
                                 const std::vector<fs::path>& directories) {
  std::error_code ignored;
  for (const fs::path& directory : directories) {
    bool its =
        fs::exists(file) && fs::equivalent(file.parent_path(), evaluation::runs_of(directory), ignored);
    for (const char* name : {evaluation::kResultsFile, evaluation::kResultsTable, evaluation::kSettingsFile,
                             evaluation::kCalibrationFile, rig::kFrontEndFile})
      its = its || fs::equivalent(file, directory / name, ignored);
    if (its)
      throw UserError(fmt::format("{} {}: is what the results in {} are made of; expected another file",
                                  option, file.string(), directory.string()));
  }
}

rig::DirectoryLock hold_out_directory(const std::string& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error)
    refuse_place(error, fmt::format("--out {}: {}; expected a directory that can be made and written", out,
                                    error.message()));
  auto lock = rig::DirectoryLock::take(out);
  if (!lock)
    throw UserError(
        fmt::format("--out {}: another waverig is at work in it; expected another directory", out));
  return std::move(*lock);
}

std::vector<ImuSample> all_of(const SampleSource& source) {
  std::vector<ImuSample> samples;
  for (ImuSample sample; source(sample);) samples.push_back(sample);
  return samples;
}

}  // namespace waverig::cli
