#include "rig/campaign/coverage.h"

#include <cmath>

#include "rig/campaign/plan.h"
#include "rig/campaign/sweep.h"

namespace waverig::rig {

std::vector<Coverage> coverage(std::uint64_t first_seed, int rigs, const std::vector<Setting>& settings,
                               double duration_s, const std::string& method) {
  std::vector<Coverage> cells;
  for (const Setting& setting : settings) cells.push_back({.setting = setting, .method = method});
  for (int k = 0; k < rigs; ++k) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(k);
    CampaignSettings campaign = read_campaign("", &seed).settings;
    campaign.methods = {method};
    campaign.sweep.settings = settings;
    campaign.sweep.repeats = 1;
    campaign.sweep.profile.steady_s = duration_s;
    const CalibratedUnit calibrated = calibrate(campaign);
    const std::vector<RunPlan> runs = plan_campaign(campaign).runs;
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (const evaluation::RunResult& run : run_embedded(campaign, calibrated.unit, runs[i], {})) {
        const evaluation::HeightStatistics& s = run.statistics;
        const double truth_m = s.mean_true_height_m, error = s.mean_height_m / truth_m - 1,
                     expanded = s.expanded_uncertainty_m / truth_m;
        Coverage& cell = cells[i];
        ++cell.rigs;
        cell.inside += std::abs(error) <= expanded ? 1 : 0;
        cell.mean_error += error;  // sums, until all are in
        cell.rms_error += error * error;
        cell.predicted += expanded * expanded / 4;
      }
  }
  for (Coverage& cell : cells) {
    cell.mean_error /= cell.rigs;
    cell.rms_error = std::sqrt(cell.rms_error / cell.rigs);
    cell.predicted = std::sqrt(cell.predicted / cell.rigs);
  }
  return cells;
}

}  // namespace waverig::rig
