#include "rig/campaign/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "rig/campaign/sensor_unit.h"

namespace waverig::rig {
namespace {

constexpr std::int64_t kPause_utime = 60 * 1000000LL;  // between runs: a set-up step of the arm

motion::EnvelopeSettings envelope_of(const CampaignSettings& settings) {
  const AccelerometerSettings accelerometer = unit_settings(settings).accelerometer;
  motion::EnvelopeSettings envelope = settings.envelope;
  envelope.sensor_range_mps2 = accelerometer.range_mps2;
  envelope.noise_mps2_sqrtHz = accelerometer.noise_density_mps2;
  envelope.drift_mps2 = accelerometer.instability_sigma_mps2;
  return envelope;
}

SettingPlan plan_sea(const CampaignSettings& campaign, const Setting& setting) {
  SettingPlan plan{
      .setting = setting, .judgements = {}, .duration_s = campaign.sweep.profile_of(setting).steady_s};
  if (const auto steep = motion::too_steep(setting.period_s, setting.height_m)) {
    plan.judgements.push_back({motion::EnvelopeReason::kBreaks, motion::Verdict::kRefuse, *steep});
    plan.refused = true;
  }
  return plan;
}

SettingPlan plan_setting(const CampaignSettings& campaign, const Setting& setting) {
  if (campaign.sweep.mover == Mover::kSea) return plan_sea(campaign, setting);
  SettingPlan plan{.setting = setting, .judgements = {}};
  const motion::RotationProfile profile(campaign.sweep.profile_of(setting));
  plan.judgements = motion::judge(setting.period_s, setting.height_m, profile.settings().ramp_periods,
                                  envelope_of(campaign));
  plan.refused = std::any_of(plan.judgements.begin(), plan.judgements.end(),
                             [](const auto& j) { return j.verdict == motion::Verdict::kRefuse; });
  plan.waves = profile.steady_periods();
  plan.duration_s = profile.duration_s();
  return plan;
}

}  // namespace

CampaignPlan plan_campaign(const CampaignSettings& campaign) {
  CampaignPlan plan;
  std::int64_t utime = campaign.start_utime;
  std::uint64_t index = 0;
  for (const Setting& setting : campaign.sweep.settings) {
    plan.settings.push_back(plan_setting(campaign, setting));
    const SettingPlan& planned = plan.settings.back();
    for (int repeat = 0; repeat < campaign.sweep.repeats; ++repeat, ++index) {
      if (planned.refused) continue;
      plan.runs.push_back({fmt::format("T{:05.2f}s_H{:05.1f}cm_r{}", setting.period_s,
                                       setting.height_m / kCentimetre, repeat + 1),
                           setting, repeat, derived_seed(campaign.seed, "run", index), utime,
                           planned.duration_s});
      plan.duration_s += planned.duration_s;
      utime += static_cast<std::int64_t>(std::ceil(planned.duration_s)) * 1000000 + kPause_utime;
    }
  }
  return plan;
}

void refuse_impossible(const CampaignSettings& campaign, const CampaignPlan& plan) {
  if (campaign.sweep.outside == OutsideEnvelope::kSkip && !plan.runs.empty()) return;
  for (const SettingPlan& planned : plan.settings)
    for (const auto& judgement : planned.judgements)
      if (judgement.verdict == motion::Verdict::kRefuse)
        throw UserError(fmt::format(
            "{}: sweep.heights_cm = {:g}: {}; expected a height that can be run, or "
            "sweep.outside_envelope = \"skip\"",
            campaign.sweep.settings_place, planned.setting.height_m / kCentimetre, judgement.sentence));
}

std::string described(const CampaignSettings& campaign, const CampaignPlan& plan) {
  std::string text = fmt::format(
      "{}: {} runs of {} settings, {:.1f} h on a rig, methods {}\n\n{:>8} {:>9} {:>8} {:>6} {:>10}  {}\n",
      campaign.name, plan.runs.size(), plan.settings.size(), plan.duration_s / 3600,
      fmt::join(campaign.methods, ", "), "period s", "height cm", "repeats", "waves", "duration s",
      "remarks");
  for (const SettingPlan& p : plan.settings) {
    std::string remarks = p.judgements.empty() ? "runs" : "";
    for (const auto& j : p.judgements)
      remarks += fmt::format("{}{}: {}", remarks.empty() ? "" : "; ",
                             j.verdict == motion::Verdict::kRefuse ? "REFUSED" : "warning", j.sentence);
    text += fmt::format("{:8.1f} {:9.1f} {:8} {:>6} {:10.0f}  {}\n", p.setting.period_s,
                        p.setting.height_m / kCentimetre, p.refused ? 0 : campaign.sweep.repeats,
                        p.waves > 0 ? fmt::to_string(p.waves) : "sea", p.duration_s, remarks);
  }
  return text;
}

std::vector<RunPlan> runs_of_shard(const CampaignPlan& plan, const Shard& shard) {
  std::vector<RunPlan> runs;
  std::size_t setting = 0;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    if (i > 0 && plan.runs[i].repeat <= plan.runs[i - 1].repeat) ++setting;
    if (static_cast<int>(setting % static_cast<std::size_t>(shard.of)) == shard.number - 1)
      runs.push_back(plan.runs[i]);
  }
  return runs;
}

}  // namespace waverig::rig
