// What a finished campaign shows: its figures, from its results and recorded runs.
#pragma once
#include <filesystem>

#include "estimator/evaluation/results.h"
#include "rig/campaign/run.h"

namespace waverig::cli {

// Draws into directory/figures with that many threads; the pictures do not depend on it.
void draw_campaign(const evaluation::CampaignResults& results, const std::filesystem::path& directory,
                   const rig::CampaignUnit& unit, int jobs);

}  // namespace waverig::cli
