// A small campaign made by formula: enough of everything for every figure and the report.
#pragma once
#include "estimator/evaluation/results.h"
#include "estimator/evaluation/run_record.h"
#include "render/figures/paper.h"

namespace waverig::test {

evaluation::CampaignResults example_campaign();

// A run of sine waves: 20 s rest, two periods of ramp, then steady; methods "harmonic" (near the truth) and
// "lee2014" (it drifts).
evaluation::RunRecord example_run(double period_s = 12, double height_m = 1.0, double steady_s = 60);

// The same on irregular seas: heights are Hm0, "harmonic" gives sea states.
evaluation::CampaignResults example_sea_campaign();
evaluation::RunRecord example_sea_run();

// Calibration report as a campaign writes it.
std::string example_calibration();

}  // namespace waverig::test
