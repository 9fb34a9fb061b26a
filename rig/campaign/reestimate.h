// A recorded run estimated again from its raw counts, as if the accelerometer had never been calibrated.
#pragma once
#include <string>
#include <vector>

#include "estimator/evaluation/run_record.h"
#include "rig/campaign/run.h"

namespace waverig::rig {

struct Reestimated {
  std::vector<estimator::ImuSample> imu;  // by nominal sensitivities
  std::vector<estimator::HeaveSample> heave;
  std::vector<estimator::Wave> waves;
};

Reestimated estimate_uncalibrated(const evaluation::RunRecord& run, const CampaignUnit& unit,
                                  const std::string& method);

}  // namespace waverig::rig
