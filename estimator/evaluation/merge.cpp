#include "estimator/evaluation/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

#include "estimator/evaluation/results_io.h"
#include "lcmtypes/error.h"

namespace waverig::evaluation {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSettingsFile = "campaign.toml";
constexpr const char* kCalibrationFile = "calibration.json";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw UserError(
        fmt::format("{}: cannot be read; expected the resolved settings of a shard", path.string()));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

UserError differs(const fs::path& a, const fs::path& b, const char* what, const std::string& in_a,
                  const std::string& in_b) {
  return UserError(fmt::format("{} and {}: {} differs ({} and {}); expected shards of one campaign",
                               a.string(), b.string(), what, in_a, in_b));
}

// First line in which two texts differ, for the complaint.
UserError settings_differ(const fs::path& a, const fs::path& b) {
  std::istringstream lines_a(text_of(a)), lines_b(text_of(b));
  std::string line_a, line_b;
  int line = 0;
  bool more = true;
  while (more && line_a == line_b) {
    const bool has_a = static_cast<bool>(std::getline(lines_a, line_a)),
               has_b = static_cast<bool>(std::getline(lines_b, line_b));
    more = has_a || has_b;
    if (!has_a) line_a.clear();
    if (!has_b) line_b.clear();
    ++line;
  }
  return UserError(fmt::format("{} and {}: line {} differs ('{}' and '{}'); expected shards of one campaign",
                               a.string(), b.string(), line, line_a, line_b));
}

}  // namespace

CampaignResults merged(std::span<const fs::path> shards, std::span<const std::string> expected_runs) {
  if (shards.empty()) throw UserError("merge: no shards; expected at least one results directory");
  CampaignResults all;
  std::map<std::pair<std::string, std::string>, const fs::path*> holder;  // by run and method
  const std::string settings = text_of(shards.front() / kSettingsFile);
  for (const fs::path& shard : shards) {
    CampaignResults part = read_results(shard);
    if (text_of(shard / kSettingsFile) != settings)
      throw settings_differ(shards.front() / kSettingsFile, shard / kSettingsFile);
    if (&shard == &shards.front()) {
      all = part;
      all.runs.clear();
    }
    if (part.seed != all.seed)
      throw differs(shards.front(), shard, "seed", std::to_string(all.seed), std::to_string(part.seed));
    if (part.version != all.version)
      throw differs(shards.front(), shard, "version", all.version, part.version);
    if (part.judged_version != all.judged_version)
      throw differs(shards.front(), shard, "version that judged", all.judged_version, part.judged_version);
    if (part.calibration_json != all.calibration_json)
      throw UserError(fmt::format("{} and {}: calibration differs; expected shards of one campaign",
                                  shards.front().string(), shard.string()));
    for (RunResult& run : part.runs) {
      if (const fs::path log = shard / "runs" / (run.run + ".lcm"); !fs::exists(log))
        throw UserError(
            fmt::format("{}: is not there; expected the log of a run that the results hold", log.string()));
      const auto [at, fresh] = holder.try_emplace({run.run, run.method}, &shard);
      if (!fresh)
        throw UserError(
            fmt::format("{} and {}: both hold run '{}' of method '{}'; expected shards that share no run",
                        at->second->string(), shard.string(), run.run, run.method));
      all.runs.push_back(std::move(run));
    }
  }
  std::sort(all.runs.begin(), all.runs.end(), [](const RunResult& a, const RunResult& b) {
    return std::tie(a.period_s, a.height_m, a.repeat, a.run, a.method) <
           std::tie(b.period_s, b.height_m, b.repeat, b.run, b.method);
  });
  for (const std::string& run : expected_runs)
    if (std::none_of(all.runs.begin(), all.runs.end(), [&](const RunResult& r) { return r.run == run; }))
      throw UserError(
          fmt::format("{} and {} more: no shard holds run '{}'; expected all shards of the campaign",
                      shards.front().string(), shards.size() - 1, run));
  all.cells = cells_of(all.runs);
  return all;
}

void merge_into(const fs::path& out, std::span<const fs::path> shards, const CampaignResults& results) {
  std::error_code error;
  if (fs::exists(out) && !fs::is_empty(out, error))
    throw UserError(fmt::format("--out {}: is not empty; expected a new or empty directory", out.string()));
  fs::create_directories(out / "runs", error);
  if (error)
    throw UserError(
        fmt::format("--out {}: {}; expected a directory that can be made", out.string(), error.message()));
  for (const char* file : {kSettingsFile, kCalibrationFile})
    if (fs::exists(shards.front() / file)) fs::copy_file(shards.front() / file, out / file);
  for (const fs::path& shard : shards) {
    if (!fs::is_directory(shard / "runs")) continue;
    for (const auto& log : fs::directory_iterator(shard / "runs"))
      if (log.is_regular_file()) fs::copy_file(log.path(), out / "runs" / log.path().filename());
  }
  write_results(out, results);
}

}  // namespace waverig::evaluation
