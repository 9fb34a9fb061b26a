#include "rig/cli/nodes/chosen_run.h"

#include <fmt/format.h>

#include "lcmtypes/error.h"
#include "rig/campaign/sensor_unit.h"

namespace waverig::cli {

ChosenRun chosen_run(const std::string& campaign, const std::string& run) {
  const rig::CampaignSettings settings = rig::read_campaign(campaign).settings;
  if (settings.sweep.mover != rig::Mover::kArm)
    throw UserError(
        fmt::format("{}: sweep.motion: a sea has no drive to be moved by; expected \"arm\"", campaign));
  std::string known;
  for (const rig::RunPlan& plan : rig::plan_campaign(settings).runs) {
    if (plan.name == run) return {settings, plan};
    known += (known.empty() ? "" : ", ") + plan.name;
  }
  throw UserError(fmt::format("--run {}: {} has no such run that the rig can make; expected one of {}", run,
                              campaign, known));
}

rig::CampaignUnit unit_on_the_rig(const rig::CampaignSettings& campaign, const std::string& calibration) {
  rig::CampaignUnit unit;
  unit.settings = rig::unit_settings(campaign);
  unit.sensitivities = rig::nominal_sensitivities(unit.settings);
  unit.front_end = campaign.calibration.front_end;
  unit.methods = campaign.estimator;
  unit.calibrated = !calibration.empty();
  if (!unit.calibrated) return unit;
  unit.calibration = estimator::load_calibration(calibration);
  unit.methods.sensor = rig::sensor_knowledge(campaign, unit.calibration);
  return unit;
}

}  // namespace waverig::cli
