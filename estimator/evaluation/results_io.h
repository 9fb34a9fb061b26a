// Results of a campaign on disk: results.csv for people and spreadsheets, results.json with everything.
//
// Both are written whole or not at all, results.json last: a folder without it, or with "complete": false, is
// not finished, and nothing here takes it for one.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// Rows of results.csv from the judged runs: the repeats of a setting and method pooled wave by wave, in the
// order period, height, method. Runs are taken in the order of their repeat, so the result does not depend on
// who ran first.
std::vector<CellResult> cells_of(std::span<const RunResult> runs);

// Text of results.csv; an unknown value is an empty cell.
std::string results_csv(std::span<const CellResult> cells);

// A campaign starts over: what an earlier one left is no result any more.
void invalidate_results(const std::filesystem::path& directory);

// Writes results.csv and results.json into an existing directory.
void write_results(const std::filesystem::path& directory, const CampaignResults& results);

// Throws UserError where results.json is missing, broken (file, line, key, what was expected) or not
// complete.
CampaignResults read_results(const std::filesystem::path& directory);

}  // namespace waverig::evaluation
