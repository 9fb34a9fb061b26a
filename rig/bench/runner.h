// Runner: carries a sequence out, step by step, each committed before the next; ends safely on every path;
// goes on where it was when it was killed.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "rig/bench/instruments.h"
#include "rig/bench/sequence.h"
#include "rig/bench/store.h"

namespace waverig::rig::bench {

struct Progress {
  const PlannedStep* step = nullptr;
  std::size_t steps = 0;
  double remaining_s = 0;
  std::int64_t utime = 0;
  int failures = 0;
  std::string alarm;  // the last one
};

// What a runner asks of its surroundings; all may be left out.
struct RunnerHooks {
  std::function<void(const Progress&)> progress;
  std::function<bool(const PlannedStep&)> prompt;  // true: go on; without it the unattended default holds
  std::function<void(const TraceRow&)> trace;      // every kTracePeriod_s of each port, as it comes
  std::function<std::string()> world_snapshot;     // of a simulated laboratory, kept with each step
  std::function<void()> clear_stop;                // after an interruption: the tear-down may wait again
  std::function<void()> breaks_off;                // before what was interrupted is torn down; throws nothing
};

inline constexpr double kTracePeriod_s = 20;

class Runner {
 public:
  Runner(const Sequence& sequence, Reactor& reactor, Store& store, RunnerHooks hooks = {});

  // From the first step, or (resume) from the first one that is not done. Returns the outcome as the store
  // has it: "done", "done with failures", or why it ended.
  std::string run(bool resume);
  Instruments& instruments() { return instruments_; }

 private:
  struct Measured {
    std::vector<RecordingRow> recordings;
    std::optional<double> value;
    std::string limits;
    std::string violation;  // of a limit
  };

  void follow_ports();                // keeps the trace
  void look_back();                   // what is done already
  void go_on();                       // tells again what sets state, as far as the run had come
  void carry_out(std::size_t index);  // with its retries; throws where the rule is to end
  Measured attempt(const PlannedStep& step);
  double wait_until(const PlannedStep& step, bool recheck);  // what it read last
  Measured record(const PlannedStep& step);
  void judge(const PlannedStep& step, double value, Measured& measured) const;
  void judge(const PlannedStep& step, const RecordingRow& row, Measured& measured) const;
  void commit(const PlannedStep& step, StepOutcome outcome, const std::string& message, std::int64_t started,
              Measured measured);
  void tear_down(bool aborted);  // throws what the store could not take, once all is safe
  void report(const PlannedStep& step);
  double read(const PlannedStep& step);

  const Sequence& sequence_;
  Reactor& reactor_;
  Store& store_;
  RunnerHooks hooks_;
  Instruments instruments_;
  std::size_t next_ = 0;
  std::vector<double> remaining_s_;             // from each step on
  std::map<int, int> attempts_;                 // so far, by step
  std::map<std::string, std::int64_t> traced_;  // by port: the last period that has its frame
  std::vector<TraceRow> trace_;                 // since the last commit
  int failures_ = 0;
  std::string alarm_;
};

std::string describe_action(const PlannedStep& step);  // "set calibrator.current 30 uA"

}  // namespace waverig::rig::bench
