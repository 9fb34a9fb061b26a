// Results of a campaign on disk: results.csv for people and spreadsheets, results.json with everything.
//
// Both are written whole or not at all, results.json last: a folder without it, or with "complete": false, is
// not finished, and nothing here takes it for one. Where the disk fills, what stood there before stays.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/cells.h"
#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// Text of results.csv; an unknown value is an empty cell. Columns of sea state and of direction stand to the
// right where any cell has them.
std::string results_csv(std::span<const CellResult> cells);

// Takes the judged runs of a campaign in any order and keeps them on disk until they are written in theirs:
// memory grows by an index entry a run, not by its waves. One thread at a time.
class ResultsWriter {
 public:
  // Into an existing directory; throws UserError where it cannot be written.
  explicit ResultsWriter(std::filesystem::path directory);
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  void add(const RunResult& run);

  // Writes results.csv and results.json. head: name, version, command, seed, complete, calibration. Returns
  // it with the cells and with all runs, of which the first hold their single waves, up to `waves_in_memory`
  // of them.
  CampaignResults finish(CampaignResults head, std::size_t waves_in_memory = 20000);

 private:
  struct Entry;
  std::filesystem::path directory_, journal_path_;
  std::FILE* journal_ = nullptr;
  std::vector<Entry> entries_;
};

// The same for results that are all at hand: the cells are written as they are.
void write_results(const std::filesystem::path& directory, const CampaignResults& results);

// A campaign starts over: what an earlier one left is no result any more.
void invalidate_results(const std::filesystem::path& directory);

// Throws UserError where results.json is missing, broken (file, line, key, what was expected) or not
// complete.
CampaignResults read_results(const std::filesystem::path& directory);

}  // namespace waverig::evaluation
