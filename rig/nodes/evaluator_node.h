// EvaluatorNode: the one node that hears the truth, the setting and every method, and judges a run.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "estimator/evaluation/run_judge.h"
#include "lcmtypes/bus.h"

namespace waverig::rig {

class EvaluatorNode {
 public:
  // Hears any method, known or not, that publishes on WAVERIG_HEAVE_…, WAVERIG_WAVE_… or WAVERIG_SEA_….
  EvaluatorNode(Bus& bus, std::string run, const evaluation::JudgeSettings& settings);
  std::vector<evaluation::RunResult> finish() { return judge_.finish(); }

 private:
  evaluation::RunJudge judge_;
};

}  // namespace waverig::rig
