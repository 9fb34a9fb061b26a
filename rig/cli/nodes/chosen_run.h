// The run of a campaign that a node is to take part in, found by its name.
#pragma once
#include <string>

#include "rig/campaign/run.h"

namespace waverig::cli {

struct ChosenRun {
  rig::CampaignSettings campaign;
  rig::RunPlan plan;
};

// Throws UserError where the campaign has no such run, or none that the rig's arm makes.
ChosenRun chosen_run(const std::string& campaign, const std::string& run);

// The unit under test as nominal, and calibrated where a file is given. The part that only a simulation knows
// is empty.
rig::CampaignUnit unit_on_the_rig(const rig::CampaignSettings& campaign, const std::string& calibration);

}  // namespace waverig::cli
