// Figures 4 to 7 of Lee, Lee, Heo 2014, for any recorded run.
#pragma once
#include <string>
#include <vector>

#include "estimator/evaluation/run_record.h"
#include "render/figure.h"

namespace waverig::render {

// What the method makes of the same run's counts at nominal sensitivities, the
// accelerometer not calibrated.
struct PaperTraces {
  std::string method = "lee2014";
  std::vector<estimator::ImuSample> imu;
  std::vector<estimator::HeaveSample> heave;  // eq (10), drift and all; its attitude levels
  std::vector<estimator::Wave> waves;
  bool empty() const { return imu.empty(); }
};

// What the method made of the calibrated samples when the run was recorded.
PaperTraces recorded_traces(const evaluation::RunRecord& run, const std::string& method);

// Figure 4: roll, pitch and specific force on three axes.
Figure inertial_data_figure(const evaluation::RunRecord& run, const PaperTraces& traces, bool calibrated);
// Figure 5: the trace of eq (10) before any correction.
Figure uncorrected_trace_figure(const evaluation::RunRecord& run, const PaperTraces& traces, bool calibrated);
// Figures 6 and 7: the corrected trace, crests aligned to zero (eq 13), above
// the single wave heights.
Figure corrected_trace_figure(const evaluation::RunRecord& run, const PaperTraces& traces, bool calibrated);

}  // namespace waverig::render
