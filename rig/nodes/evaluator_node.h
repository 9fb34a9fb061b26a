// EvaluatorNode: the one node that hears the truth, the setting and every method, and judges a run.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/evaluation/run_judge.h"
#include "lcmtypes/bus.h"
#include "rig/nodes/sequence_watch.h"

namespace waverig::rig {

class EvaluatorNode {
 public:
  // Hears any method, known or not, that publishes on WAVERIG_HEAVE_…, WAVERIG_WAVE_… or WAVERIG_SEA_….
  EvaluatorNode(Bus& bus, std::string run, const evaluation::JudgeSettings& settings);
  // A method of whose waves some were lost on the bus carries flag::kGap.
  std::vector<evaluation::RunResult> finish();

  std::int64_t truths_missing() const {
    return truths_.missing();
  }  // the judge bridges them by straight lines

 private:
  evaluation::RunJudge judge_;
  SequenceWatch truths_;
  std::map<std::string, SequenceWatch, std::less<>> waves_;
};

}  // namespace waverig::rig
