#include "rig/campaign/results_directory.h"

#include <fmt/format.h>

#include <stdexcept>

#include "estimator/evaluation/results_files.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "rig/campaign/settings.h"

namespace waverig::rig {
namespace fs = std::filesystem;
namespace {

using evaluation::kCalibrationFile, evaluation::kSettingsFile;
constexpr const char* kResolved = "the resolved settings of a campaign";

fs::path beside(fs::path directory, const char* suffix) { return directory += suffix; }

// What can be renamed and have a neighbour: the directory that a link leads to, and no "DIR/" and no ".".
fs::path place_of(const fs::path& directory) {
  fs::path place = led_to(directory);
  return place.filename() == "." || place.filename() == ".." ? fs::canonical(place) : place;
}

// Of a campaign, or of waverig analyse compass.
bool holds_results(const fs::path& directory) {
  return fs::exists(directory / evaluation::kResultsFile) || fs::exists(directory / "compass.csv");
}

// Under its own name once it is whole. Logs are large and nobody writes into one that is there: a second name
// for the same file where the disk can, else a copy.
void take_file(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from) || (fs::exists(to) && fs::equivalent(from, to))) return;
  fs::path partial = to;
  partial += ".partial";
  fs::remove(partial);
  std::error_code error;
  if (from.extension() == ".lcm") fs::create_hard_link(from, partial, error);
  if (!fs::exists(partial) && !fs::copy_file(from, partial, error)) {
    const std::string reason = error.message();
    fs::remove(partial, error);
    throw std::runtime_error(fmt::format("{}: not everything could be written: {}", to.string(), reason));
  }
  rename_whole(partial, to);
}

}  // namespace

ResultsDirectory::ResultsDirectory(const fs::path& directory, Mode mode, bool resumes)
    : directory_(directory),
      place_(place_of(directory)),
      working_(beside(place_, ".partial")),
      resumes_(resumes) {
  if (fs::exists(place_) && !fs::is_directory(place_))
    throw UserError(fmt::format("--out {}: is a file; expected a directory", directory_.string()));
  const bool finished = fs::exists(place_) && !fs::is_empty(place_);
  const bool begun = fs::exists(working_);
  if (begun) lock();
  if (finished && mode != Mode::kReplace && !(begun && mode == Mode::kResume))
    throw UserError(
        fmt::format("--out {}: is there already; expected a new directory, or --replace to do it anew",
                    directory_.string()));
  if (finished && !holds_results(place_))
    throw UserError(fmt::format(
        "--out {}: holds no results that --replace could replace; expected a results directory or a new one",
        directory_.string()));
  if (mode == Mode::kFresh && begun)
    throw UserError(fmt::format("--out {}: {} is unfinished; expected {}--replace to do it anew",
                                directory_.string(), working_.string(),
                                resumes ? "--resume to go on or " : ""));
  if (mode == Mode::kReplace) {
    fs::remove_all(working_);
    lock_.reset();  // of what is gone
  }
  std::error_code error;
  fs::create_directories(runs(), error);
  if (error) {
    std::error_code ignored;
    if (!begun) fs::remove_all(working_, ignored);
    refuse_place(error, fmt::format("--out {}: cannot be made: {}; expected a writable place",
                                    directory_.string(), error.message()));
  }
  if (!lock_) lock();
}

// What no command could go on with would only be in the next one's way.
ResultsDirectory::~ResultsDirectory() {
  std::error_code ignored;
  if (!resumes_ && !finished_) fs::remove_all(working_, ignored);
}

void ResultsDirectory::lock() {
  lock_ = DirectoryLock::take(working_);
  if (!lock_)
    throw UserError(fmt::format("--out {}: another waverig is at work in {}; expected another directory",
                                directory_.string(), working_.string()));
}

void ResultsDirectory::claim(const std::string& resolved_settings, const std::string& version) {
  const fs::path settings = working_ / kSettingsFile;
  const std::string made_by = fmt::format("# waverig {}\n", version);
  if (fs::exists(settings)) {
    const std::string begun = content_of(settings, kResolved);
    if (!begun.starts_with(made_by))
      throw UserError(
          fmt::format("--resume: {}:1: '{}': was begun by another version; expected '# waverig {}', or "
                      "--replace to do it anew",
                      settings.string(), begun.substr(0, begun.find('\n')), version));
    if (begun != made_by + resolved_settings)
      throw UserError(
          fmt::format("--resume: {}: was begun with other settings; expected the same campaign and seed",
                      settings.string()));
  }
  write_atomically(settings, made_by + resolved_settings);
}

void ResultsDirectory::finish() {
  if (fs::exists(place_)) {
    const fs::path old = beside(place_, ".replaced");
    fs::remove_all(old);
    fs::rename(place_, old);
    rename_whole(working_, place_);
    fs::remove_all(old);
  } else {
    rename_whole(working_, place_);
  }
  finished_ = true;
}

void refuse_other_campaign(const fs::path& from, const fs::path& to) {
  const fs::path settings = to / kSettingsFile;
  if (fs::exists(settings) && content_of(settings, kResolved) != content_of(from / kSettingsFile, kResolved))
    throw UserError(fmt::format("--out {}: {} is of another campaign than {}; expected a new directory",
                                to.string(), settings.string(), (from / kSettingsFile).string()));
}

void take_campaign(const fs::path& from, const fs::path& to) {
  fs::create_directories(evaluation::runs_of(to));
  for (const char* file : {kSettingsFile, kCalibrationFile, kFrontEndFile}) take_file(from / file, to / file);
  for (const auto& log : fs::directory_iterator(evaluation::runs_of(from)))
    if (log.path().extension() == ".lcm")
      take_file(log.path(), evaluation::runs_of(to) / log.path().filename());
}

}  // namespace waverig::rig
