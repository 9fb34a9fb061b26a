// A whole campaign: calibrate, run, judge, write down. Figures are the caller's.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"
#include "rig/campaign/results_directory.h"
#include "rig/campaign/run.h"

namespace waverig::rig {

struct SweepOptions {
  int jobs = 1;
  Shard shard;
  std::string command;  // as given, for provenance
  std::string version;
};

// Six positions on the campaign's unit, through the real counts path.
struct CalibratedUnit {
  CampaignUnit unit;
  std::string report_json;  // the calibration beside the simulated truth; empty where there was none
};
CalibratedUnit calibrate(const CampaignSettings& campaign);

// Runs what is not there yet in directory.runs(), judges all, and writes results.csv and results.json. Same
// seed, same results and same log bytes, for any number of jobs.
evaluation::CampaignResults run_campaign(const Campaign& campaign, const CalibratedUnit& calibrated,
                                         const std::vector<RunPlan>& runs, const ResultsDirectory& directory,
                                         const SweepOptions& options);

// The table of results for people: a row a setting and method. Of regular waves their heights, of seas the
// heave and the sea state.
std::string results_table(const evaluation::CampaignResults& results, Mover mover);

}  // namespace waverig::rig
