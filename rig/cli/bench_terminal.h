// What a bench shows while it runs: one line on stderr with the step, the remaining time and alarms. On a
// terminal the line stays where it is; elsewhere only alarms are written, each once.
#pragma once
#include <atomic>
#include <chrono>
#include <string>

#include "rig/bench/runner.h"

namespace waverig::cli {

class BenchTerminal {
 public:
  BenchTerminal();
  ~BenchTerminal();
  BenchTerminal(const BenchTerminal&) = delete;
  BenchTerminal& operator=(const BenchTerminal&) = delete;

  void show(const rig::bench::Progress& progress);
  bool ask(const std::string& question);  // true: go on
  bool interactive() const { return interactive_; }

 private:
  void clear();

  bool terminal_, interactive_;
  int failures_ = 0;
  std::string alarm_;
  std::chrono::steady_clock::time_point drawn_;
};

// SIGINT, SIGTERM and SIGHUP set the flag instead of ending the program, so that the bench is left safe; a
// second one ends it.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  const std::atomic<bool>& asked() const;
  void clear();
};

}  // namespace waverig::cli
