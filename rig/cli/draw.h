// What a finished campaign shows: its figures, from its results and recorded runs.
#pragma once
#include <filesystem>
#include <vector>

#include "estimator/evaluation/results.h"
#include "rig/campaign/run.h"

namespace waverig::cli {

struct DrawOptions {
  bool dark = false;
  bool svg = false;
};

// Draws into directory/figures with that many threads, on which the pictures do not depend; returns their
// paths.
std::vector<std::filesystem::path> draw_campaign(const evaluation::CampaignResults& results,
                                                 const std::filesystem::path& directory,
                                                 const rig::CampaignUnit& unit, int jobs,
                                                 const DrawOptions& options = {});

}  // namespace waverig::cli
