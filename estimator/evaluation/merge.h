// Shards of one campaign, run on many machines, become one results directory.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// The results of all shards, cells pooled anew. Throws UserError, naming both directories, where a shard is
// not finished, was run with other settings (campaign.toml), another seed or version, or holds a run that
// another has too; and where one of expected_runs, the runs of the whole campaign, is in no shard.
CampaignResults merged(std::span<const std::filesystem::path> shards,
                       std::span<const std::string> expected_runs);

// Writes merged results into `out`, which must not exist yet or be empty: settings, calibration and every
// run's log are copied, results.csv and results.json written last.
void merge_into(const std::filesystem::path& out, std::span<const std::filesystem::path> shards,
                const CampaignResults& results);

}  // namespace waverig::evaluation
