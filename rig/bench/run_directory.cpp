#include "rig/bench/run_directory.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

namespace fs = std::filesystem;
constexpr const char* kSequenceDirectory = "sequence";

std::vector<fs::path> files_behind(const Sequence& sequence) {
  std::vector<fs::path> files = {fs::absolute(sequence.file).lexically_normal()};
  for (const fs::path& file : sequence.laboratory.files)
    files.push_back(fs::absolute(file).lexically_normal());
  return files;
}

// The deepest directory that all files lie in.
fs::path common_directory(const std::vector<fs::path>& files) {
  fs::path common = files.front().parent_path();
  for (const fs::path& file : files) {
    const auto [end, other] = std::ranges::mismatch(common, file);
    fs::path shorter;
    for (auto part = common.begin(); part != end; ++part) shorter /= *part;
    common = shorter;
  }
  return common;
}

}  // namespace

std::string keep_files(const Sequence& sequence, const fs::path& out) {
  const std::vector<fs::path> files = files_behind(sequence);
  const fs::path common = common_directory(files);
  for (const fs::path& file : files) {
    const fs::path copy = out / kSequenceDirectory / file.lexically_relative(common);
    std::error_code error;
    fs::create_directories(copy.parent_path(), error);
    if (!error) fs::copy_file(file, copy, fs::copy_options::overwrite_existing, error);
    if (error)
      refuse_place(error, fmt::format("{}: {}: expected to write a copy of {}", copy.string(),
                                      error.message(), file.string()));
  }
  return (kSequenceDirectory / files.front().lexically_relative(common)).string();
}

Sequence kept_sequence(const fs::path& out, const RunInfo& info) {
  Sequence sequence = load_sequence(out / info.sequence);
  if (sequence.fingerprints != info.files)
    throw UserError(fmt::format(
        "{}: it or a file that it includes has changed since the run: expected them as the run kept them",
        (out / info.sequence).string()));
  return sequence;
}

std::optional<Analysis> analyse_run(const Sequence& sequence, const Store& store,
                                    const estimator::FrontEndCalibration* known) {
  if (sequence.procedure == "none") return std::nullopt;
  Analysis analysis = analyse(sequence, store, known);
  if (known != nullptr) analysis.calibration = merge(*known, analysis.calibration);
  return analysis;
}

}  // namespace waverig::rig::bench
