#include "rig/campaign/results_directory.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "estimator/evaluation/atomic_file.h"
#include "lcmtypes/error.h"

namespace waverig::rig {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSettingsFile = "campaign.toml";

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

fs::path partial_of(fs::path directory) {
  if (directory.filename().empty()) directory = directory.parent_path();  // DIR/ means DIR
  return directory += ".partial";
}

// Of a campaign, or of waverig analyse compass.
bool holds_results(const fs::path& directory) {
  return fs::exists(directory / "results.json") || fs::exists(directory / "compass.csv");
}

}  // namespace

ResultsDirectory::ResultsDirectory(const fs::path& directory, Mode mode)
    : directory_(directory), working_(partial_of(directory)), mode_(mode) {
  if (fs::exists(directory_) && !fs::is_directory(directory_))
    throw UserError(fmt::format("--out {}: is a file; expected a directory", directory_.string()));
  const bool finished = fs::exists(directory_) && !fs::is_empty(directory_);
  if (finished && mode != Mode::kReplace)
    throw UserError(
        fmt::format("--out {}: is there already; expected a new directory, or --replace to do it anew",
                    directory_.string()));
  if (finished && !holds_results(directory_))
    throw UserError(fmt::format(
        "--out {}: holds no results that --replace could replace; expected a results directory or a new one",
        directory_.string()));
  if (mode == Mode::kFresh && fs::exists(working_))
    throw UserError(fmt::format(
        "--out {}: {} holds an unfinished campaign; expected --resume to go on or --replace to do it anew",
        directory_.string(), working_.string()));
  if (mode == Mode::kReplace) fs::remove_all(working_);
  std::error_code error;
  fs::create_directories(runs(), error);
  if (error)
    throw UserError(fmt::format("--out {}: cannot be made: {}; expected a writable place",
                                directory_.string(), error.message()));
}

void ResultsDirectory::claim(const std::string& resolved_settings, const std::string& version) {
  const fs::path settings = working_ / kSettingsFile;
  const std::string made_by = fmt::format("# waverig {}\n", version);
  if (fs::exists(settings)) {
    const std::string begun = read_text(settings);
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
  evaluation::write_atomically(settings, made_by + resolved_settings);
}

void ResultsDirectory::finish() {
  if (fs::exists(directory_)) {
    fs::path old = directory_;
    if (old.filename().empty()) old = old.parent_path();
    old += ".replaced";
    fs::remove_all(old);
    fs::rename(directory_, old);
    fs::rename(working_, directory_);
    fs::remove_all(old);
  } else {
    fs::rename(working_, directory_);
  }
}

}  // namespace waverig::rig
