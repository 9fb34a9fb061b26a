// One run of a campaign in embedded mode: every node in one process on one bus, virtual time, as fast as it
// goes.
#pragma once
#include <filesystem>
#include <vector>

#include "estimator/calibration/accelerometer_calibration.h"
#include "estimator/evaluation/run_judge.h"
#include "rig/campaign/plan.h"
#include "rig/campaign/settings.h"
#include "rig/nodes/encoder_truth.h"
#include "rig/nodes/run_announcer.h"
#include "rig/nodes/simulated_rig.h"

namespace waverig::rig {

// What a campaign finds out before its first run and every run uses.
struct CampaignUnit {
  UnitSettings settings;
  UnitParameters tested;  // the simulator's truth
  Sensitivities sensitivities;
  std::optional<FrontEndChoice> front_end;  // its own calibration, where the campaign names one
  bool calibrated = false;
  estimator::SensorCalibration calibration;
  estimator::MethodSettings methods;  // with what the calibration says of itself
};

// Records into log (no recording where it is empty) and returns one result a method.
// Throws NegativeAnswer where the motion ended in an alarm.
std::vector<evaluation::RunResult> run_embedded(const CampaignSettings& campaign, const CampaignUnit& unit,
                                                const RunPlan& plan, const std::filesystem::path& log);

// The parts of a run, for any mode.
SimulatedRigSettings rig_settings(const CampaignSettings& campaign, const CampaignUnit& unit,
                                  const RunPlan& plan);
motion::RotationProfile profile_of(const CampaignSettings& campaign, const RunPlan& plan);
OrderedRun ordered_run(const RunPlan& plan);
ArmPlacement arm_placement(const CampaignSettings& campaign, const RunPlan& plan);
Acquisition acquisition_of(const CampaignUnit& unit);

// How the judge of a run of this campaign is set, embedded or from its log.
evaluation::JudgeSettings judge_settings(const CampaignUnit& unit);
evaluation::JudgeSettings judge_settings(const CampaignSettings& campaign, const CampaignUnit& unit,
                                         const RunPlan& plan);  // with the bounds of its sea

}  // namespace waverig::rig
