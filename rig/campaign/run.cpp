#include "rig/campaign/run.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "lcmtypes/error.h"
#include "rig/campaign/sea_bound.h"
#include "rig/campaign/sensor_unit.h"
#include "rig/nodes/acquisition_node.h"
#include "rig/nodes/estimator_node.h"
#include "rig/nodes/evaluator_node.h"
#include "rig/nodes/motion_node.h"
#include "rig/nodes/recorder_node.h"
#include "rig/nodes/simulated_rig.h"
#include "rig/nodes/simulated_sea.h"

namespace waverig::rig {

ArmPlacement arm_placement(const CampaignSettings& campaign, const RunPlan& plan) {
  return {plan.setting.height_m / 2,
          campaign.arm.azimuth_rad + plan.repeat * campaign.sweep.turn_per_repeat_rad};
}

SimulatedRigSettings rig_settings(const CampaignSettings& campaign, const CampaignUnit& unit,
                                  const RunPlan& plan) {
  SimulatedRigSettings rig{.drive = campaign.drive, .arm = campaign.arm, .unit = unit.settings};
  rig.drive.counts_per_turn = campaign.axis.counts_per_turn;
  rig.drive.seed = plan.seed;
  const ArmPlacement placement = arm_placement(campaign, plan);
  rig.radius_m = placement.radius_m;
  rig.noise_seed = plan.seed;
  rig.arm.azimuth_rad = placement.azimuth_rad;
  if (rig.unit.magnetometer) rig.unit.magnetometer->motor = motor_field(campaign, rig.arm.azimuth_rad);
  return rig;
}

motion::RotationProfile profile_of(const CampaignSettings& campaign, const RunPlan& plan) {
  return motion::RotationProfile(campaign.sweep.profile_of(plan.setting));
}

OrderedRun ordered_run(const RunPlan& plan) {
  return {plan.setting.period_s, plan.setting.height_m, plan.repeat};
}

Acquisition acquisition_of(const CampaignUnit& unit) {
  Acquisition acquisition(unit.sensitivities);
  if (unit.front_end) acquisition.apply(*unit.front_end);
  if (unit.calibrated) acquisition.apply(unit.calibration.accelerometer, unit.calibration.gyroscope);
  if (unit.calibration.compass) acquisition.apply(*unit.calibration.compass);
  return acquisition;
}

namespace {

SimulatedSeaSettings sea_settings(const CampaignSettings& campaign, const CampaignUnit& unit,
                                  const RunPlan& plan) {
  SimulatedSeaSettings sea{.sea = campaign.sweep.sea, .buoy = campaign.sweep.buoy, .unit = unit.settings};
  sea.sea.tp_s = plan.setting.period_s;
  sea.sea.hm0_m = plan.setting.height_m;
  sea.sea.seed = sea.buoy.seed = sea.noise_seed = plan.seed;
  sea.buoy.start_utime = plan.start_utime;
  sea.duration_s = plan.duration_s;
  return sea;
}

void turn_arm(Bus& bus, const CampaignSettings& campaign, const CampaignUnit& unit, const RunPlan& plan,
              AcquisitionNode& acquisition) {
  SimulatedRig rig(bus, rig_settings(campaign, unit, plan), unit.tested, plan.start_utime);
  MotionNode motion(bus, rig.drive(), campaign.axis, profile_of(campaign, plan), ordered_run(plan));
  const double period_s = campaign.axis.control_period_s;
  const auto period_us = static_cast<std::int64_t>(period_s * 1e6);
  for (std::int64_t utime = plan.start_utime; !motion.finished(); utime += period_us) {
    motion.cycle(utime);
    acquisition.take(rig.advance(period_s));
    bus.drain();
  }
  if (!motion.alarm().empty())
    throw NegativeAnswer(fmt::format("run {}: motion stopped by an alarm: {}", plan.name, motion.alarm()));
}

void float_on_sea(Bus& bus, const CampaignSettings& campaign, const CampaignUnit& unit, const RunPlan& plan,
                  AcquisitionNode& acquisition) {
  SimulatedSea sea(bus, sea_settings(campaign, unit, plan), unit.tested, plan.start_utime, ordered_run(plan));
  while (!sea.finished()) {
    acquisition.take(sea.advance(unit.settings.sample_interval_s));
    bus.drain();
  }
}

}  // namespace

evaluation::JudgeSettings judge_settings(const CampaignUnit& unit) {
  return {.noise_density_mps2_rthz = unit.settings.accelerometer.noise_density_mps2,
          .sample_rate_hz = 1 / unit.settings.sample_interval_s,
          .tells_waves = estimator::tells_waves};
}

evaluation::JudgeSettings judge_settings(const CampaignSettings& campaign, const CampaignUnit& unit,
                                         const RunPlan& plan) {
  evaluation::JudgeSettings settings = judge_settings(unit);
  settings.motion =
      campaign.sweep.mover == Mover::kSea ? evaluation::Motion::kSea : evaluation::Motion::kRegular;
  if (campaign.sweep.mover != Mover::kSea) return settings;
  const evaluation::HeaveBound bound =
      sea_bound(sea_settings(campaign, unit, plan).sea, unit.settings.accelerometer);
  for (const std::string& method : campaign.methods)
    settings.heave_bound_m[method] =
        bound.record_m(heave_lag_s(method, unit.methods.fixed_lag_s), plan.duration_s);
  return settings;
}

std::vector<evaluation::RunResult> run_embedded(const CampaignSettings& campaign, const CampaignUnit& unit,
                                                const RunPlan& plan, const std::filesystem::path& log) {
  Bus bus("memq://");
  std::optional<RecorderNode> recorder;
  if (!log.empty()) recorder.emplace(bus, log);

  AcquisitionNode acquisition(bus, acquisition_of(unit));
  std::vector<std::unique_ptr<EstimatorNode>> estimators;
  for (const std::string& method : campaign.methods)
    estimators.push_back(std::make_unique<EstimatorNode>(bus, method, unit.methods));
  EvaluatorNode evaluator(bus, plan.name, judge_settings(campaign, unit, plan));

  campaign.sweep.mover == Mover::kArm ? turn_arm(bus, campaign, unit, plan, acquisition)
                                      : float_on_sea(bus, campaign, unit, plan, acquisition);
  if (recorder) recorder->close();
  return evaluator.finish();
}

}  // namespace waverig::rig
