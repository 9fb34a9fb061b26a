// The plan of a campaign: which runs, in which order, with which seeds and at which virtual times; and what
// speaks against each setting.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "motion/envelope.h"
#include "rig/campaign/settings.h"

namespace waverig::rig {

struct RunPlan {
  std::string name;  // of its files, e.g. T06.00s_H060.0cm_r1
  Setting setting;
  int repeat = 0;          // from 0
  std::uint64_t seed = 0;  // its own, whatever else runs
  std::int64_t start_utime = 0;
  double duration_s = 0;
};

struct SettingPlan {
  Setting setting;
  std::vector<motion::Judgement> judgements;
  bool refused = false;
  int waves = 0;          // whole steady ones of a run; 0 on a sea
  double duration_s = 0;  // of one run
};

struct CampaignPlan {
  std::vector<SettingPlan> settings;
  std::vector<RunPlan> runs;  // of the settings that are not refused, repeats together
  double duration_s = 0;      // of all runs, as a rig would take
};

CampaignPlan plan_campaign(const CampaignSettings& settings);

// Throws UserError, naming file and line of the heights, at the first refused setting where the campaign
// refuses them.
void refuse_impossible(const CampaignSettings& settings, const CampaignPlan& plan);

// What would run, as a table for people.
std::string described(const CampaignSettings& settings, const CampaignPlan& plan);

// Shard K of N takes every Nth setting, so that the repeats of a cell stay together.
struct Shard {
  int number = 1, of = 1;
};
std::vector<RunPlan> runs_of_shard(const CampaignPlan& plan, const Shard& shard);

}  // namespace waverig::rig
