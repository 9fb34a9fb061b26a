#include "estimator/evaluation/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::evaluation {
namespace fs = std::filesystem;
namespace {

std::string settings_of(const fs::path& shard) {
  return content_of(shard / kSettingsFile, "the resolved settings of a shard");
}

UserError differs(const fs::path& a, const fs::path& b, const char* what, const std::string& in_a,
                  const std::string& in_b) {
  return UserError(fmt::format("{} and {}: {} differs ({} and {}); expected shards of one campaign",
                               a.string(), b.string(), what, in_a, in_b));
}

// First line in which two texts differ, for the complaint.
UserError settings_differ(const fs::path& a, const fs::path& b) {
  std::istringstream lines_a(settings_of(a)), lines_b(settings_of(b));
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
                               (a / kSettingsFile).string(), (b / kSettingsFile).string(), line, line_a,
                               line_b));
}

// What merge_into copies is what the results say.
void check_calibration(const fs::path& shard, const CampaignResults& results) {
  using Json = nlohmann::json;
  const fs::path file = shard / kCalibrationFile;
  if (results.calibration_json.empty() && !fs::exists(file)) return;
  constexpr const char* kExpected = "the calibration that the shard's results hold";
  const Json there = Json::parse(content_of(file, kExpected), nullptr, false),
             held = Json::parse(results.calibration_json, nullptr, false);
  if (!(there == held))  // what is no JSON equals nothing
    throw UserError(fmt::format("{}: is another one; expected {}", file.string(), kExpected));
}

}  // namespace

CampaignResults merged(std::span<const fs::path> shards, std::span<const std::string> expected_runs) {
  if (shards.empty()) throw UserError("merge: no shards; expected at least one results directory");
  CampaignResults all;
  std::map<std::pair<std::string, std::string>, const fs::path*> holder;  // by run and method
  const std::string settings = settings_of(shards.front());
  for (const fs::path& shard : shards) {
    CampaignResults part = read_results(shard);
    if (settings_of(shard) != settings) throw settings_differ(shards.front(), shard);
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
      if (const fs::path log = log_of(shard, run.run); !fs::is_regular_file(log))
        throw UserError(fmt::format("{}: is {}; expected the log of a run that the results hold",
                                    log.string(), fs::exists(log) ? "no file" : "not there"));
      const auto [at, fresh] = holder.try_emplace({run.run, run.method}, &shard);
      if (!fresh)
        throw UserError(
            fmt::format("{} and {}: both hold run '{}' of method '{}'; expected shards that share no run",
                        at->second->string(), shard.string(), run.run, run.method));
      all.runs.push_back(std::move(run));
    }
  }
  check_calibration(shards.front(), all);
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
  fs::create_directories(runs_of(out), error);
  if (error)
    throw UserError(
        fmt::format("--out {}: {}; expected a directory that can be made", out.string(), error.message()));
  for (const char* file : {kSettingsFile, kCalibrationFile})
    if (fs::exists(shards.front() / file)) fs::copy_file(shards.front() / file, out / file);
  for (const fs::path& shard : shards) {
    if (!fs::is_directory(runs_of(shard))) continue;
    for (const auto& log : fs::directory_iterator(runs_of(shard)))
      if (log.is_regular_file()) fs::copy_file(log.path(), runs_of(out) / log.path().filename());
  }
  write_results(out, results);
}

}  // namespace waverig::evaluation
