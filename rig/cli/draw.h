// What a finished campaign shows: its figures, from the recorded runs.
#pragma once
#include <filesystem>

#include "estimator/evaluation/results.h"
#include "rig/campaign/run.h"

namespace waverig::cli {

// Draws into directory/figures; jobs threads at most.
void draw_campaign(const evaluation::CampaignResults& results, const std::filesystem::path& directory,
                   const rig::Campaign& campaign, const rig::CampaignUnit& unit, int jobs);

}  // namespace waverig::cli
