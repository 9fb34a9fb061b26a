// The bench as a whole: a sequence, carried out against a simulated or a real laboratory, analysed and
// reported.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "rig/bench/run_directory.h"
#include "rig/bench/runner.h"
#include "rig/bench/simulation/faults.h"

namespace waverig::rig::bench {

struct BenchOptions {
  std::filesystem::path out;  // the run's directory
  bool simulate = false;
  SimulationSettings simulation;
  bool resume = false;
  std::string version;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Progress&)> progress;
  std::function<bool(const PlannedStep&)> prompt;
  std::function<void(const TraceRow&)> trace;
  std::function<void()> clear_stop;
};

struct BenchResult {
  std::string outcome;    // as Runner::run
  bool complete = false;  // every step was carried out
};

// Carries the sequence out into options.out (bench.sqlite). Throws UserError where it cannot begin or go on:
// another run is there, the files have changed since, a broken ramp, another bench at work in the directory.
BenchResult run_bench(const Sequence& sequence, const BenchOptions& options);

}  // namespace waverig::rig::bench
