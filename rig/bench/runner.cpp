#include "rig/bench/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr double kRetryPause_s = 5;
constexpr double kRecordingSlice_s = 0.02;  // of virtual time, about a recording's end

std::int64_t microseconds(double seconds) { return std::llround(seconds * 1e6); }

// A step's retries are used up and its rule is to end the run.
struct EndRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string show(const Limit& limit, double value) {
  std::string bounds;
  if (std::isfinite(limit.low_si)) bounds += " from " + show_quantity(limit.low_si, limit.base);
  if (std::isfinite(limit.high_si)) bounds += " to " + show_quantity(limit.high_si, limit.base);
  return fmt::format("{} = {}: expected{}", limit.of, show_quantity(value, limit.base), bounds);
}

}  // namespace

std::string describe_action(const PlannedStep& step) {
  std::string text = name_of(step.verb);
  if (!step.instrument.empty()) text += " " + step.instrument + "." + step.name;
  if (step.verb == Verb::kSet) text += " " + step.value;
  if (step.verb == Verb::kWait) text += " " + show_duration(step.duration_s);
  if (step.verb == Verb::kRecord)
    text += fmt::format(" {} {}", fmt::join(step.ports, "+"), show_duration(step.duration_s));
  if (step.verb == Verb::kPrompt) text += " \"" + step.text + "\"";
  return text;
}

Runner::Runner(const Sequence& sequence, Reactor& reactor, Store& store, RunnerHooks hooks)
    : sequence_(sequence),
      reactor_(reactor),
      store_(store),
      hooks_(std::move(hooks)),
      instruments_(sequence.laboratory, reactor) {
  remaining_s_.resize(sequence.plan.size() + 1);
  for (std::size_t i = sequence.plan.size(); i-- > 0;)
    remaining_s_[i] = remaining_s_[i + 1] + sequence.plan[i].expected_s;
}

std::string Runner::run(bool resume) {
  bool aborted = false;
  std::string outcome;
  reactor_.heed_stop(true);
  if (resume) look_back();
  try {
    store_.set_instruments(instruments_.identify());
    follow_ports();
    if (resume) go_on();
    store_.set_outcome("running");
    for (; next_ < sequence_.plan.size() && sequence_.plan[next_].section != Section::kTeardown; ++next_)
      carry_out(next_);
  } catch (const std::exception& error) {
    // Instruments, rules, the user: whatever it is, leave everything safe.
    aborted = true;
    outcome = error.what();
    if (hooks_.clear_stop) hooks_.clear_stop();
    if (hooks_.breaks_off) hooks_.breaks_off();
  }
  reactor_.heed_stop(false);
  tear_down(aborted);
  if (!aborted) outcome = failures_ > 0 ? "done with failures" : "done";
  store_.set_outcome(outcome);
  return outcome;
}

void Runner::follow_ports() {
  for (auto& [name, port] : instruments_.ports()) {
    std::int64_t& last = traced_[name];
    port->on_frame = [this, &name = name, &last](const std::vector<std::int64_t>& raw) {
      const std::int64_t period = reactor_.now() / microseconds(kTracePeriod_s);
      if (period == last) return;
      last = period;
      trace_.push_back({name, reactor_.now(), raw});
      if (hooks_.trace) hooks_.trace(trace_.back());
    };
  }
}

void Runner::look_back() {
  for (const StepRow& row : store_.steps()) {
    attempts_[row.index] = std::max(attempts_[row.index], row.attempt);
    if (row.outcome == StepOutcome::kAccepted) ++failures_;
    if (row.outcome == StepOutcome::kDone || row.outcome == StepOutcome::kAccepted)
      next_ = std::max(next_, static_cast<std::size_t>(row.index) + 1);
  }
  for (const TraceRow& t : store_.trace()) traced_[t.port] = t.utime / microseconds(kTracePeriod_s);
  for (const auto& [name, frame] : store_.resume_state().last_frames)
    if (const auto port = instruments_.ports().find(name); port != instruments_.ports().end())
      port->second->set_last_frame(frame);
}

// The run was killed, or ended: the instruments may have forgotten everything. Nothing is measured here.
void Runner::go_on() {
  std::map<std::string, std::size_t> last_of;  // each setting as it was told last
  const PlannedStep* last_wait = nullptr;
  for (std::size_t i = 0; i < next_; ++i) {
    const PlannedStep& step = sequence_.plan[i];
    if (step.verb == Verb::kSet) last_of[step.instrument + "." + step.name] = i;
    if (step.verb == Verb::kUntil) last_wait = &step;
    if (step.verb == Verb::kSet && last_wait != nullptr && step.instrument == last_wait->instrument)
      last_wait = nullptr;
  }
  std::vector<std::size_t> again;
  for (const auto& [target, index] : last_of) again.push_back(index);
  std::ranges::sort(again);
  for (const std::size_t index : again) {
    const PlannedStep& step = sequence_.plan[index];
    const Instrument& instrument = *sequence_.laboratory.instrument(step.instrument);
    // A simulated laboratory is as it was; a real one needs the set-up's own waits, e.g. for a unit to start.
    if (reactor_.virtual_time() == nullptr && index > 0 && sequence_.plan[index - 1].verb == Verb::kWait)
      reactor_.sleep_until(reactor_.now() + microseconds(sequence_.plan[index - 1].duration_s));
    instruments_.set(instrument, *instrument.setting(step.name), step.command_value);
  }
  if (last_wait != nullptr) wait_until(*last_wait, true);
}

void Runner::carry_out(std::size_t index) {
  const PlannedStep& step = sequence_.plan[index];
  report(step);
  for (int tries = 0;; ++tries) {
    const std::int64_t started = reactor_.now();
    ++attempts_[step.index];
    Measured measured;
    std::string fault;
    try {
      measured = attempt(step);
      fault = measured.violation;
    } catch (const InstrumentError& error) {
      fault = error.what();
    }
    for (auto& [name, port] : instruments_.ports()) port->give_up();
    if (fault.empty()) {
      commit(step, StepOutcome::kDone, "", started, std::move(measured));
      return;
    }
    alarm_ = fault;
    const bool last = tries >= step.retries;
    if (last && !step.abort) ++failures_;
    commit(step, last && !step.abort ? StepOutcome::kAccepted : StepOutcome::kFailed, fault, started,
           std::move(measured));
    report(step);
    if (last && step.abort) throw EndRun(fmt::format("{}: {}: {}", step.where, describe_action(step), fault));
    if (last) return;
    reactor_.sleep_until(reactor_.now() + microseconds(kRetryPause_s));
  }
}

double Runner::read(const PlannedStep& step) {
  const Instrument& instrument = *sequence_.laboratory.instrument(step.instrument);
  return instruments_.read(instrument, *instrument.reading(step.name));
}

Runner::Measured Runner::attempt(const PlannedStep& step) {
  Measured measured;
  switch (step.verb) {
    case Verb::kSet: {
      const Instrument& instrument = *sequence_.laboratory.instrument(step.instrument);
      instruments_.set(instrument, *instrument.setting(step.name), step.command_value);
      break;
    }
    case Verb::kRead:
      measured.value = read(step);
      judge(step, *measured.value, measured);
      break;
    case Verb::kWait:
      reactor_.sleep_until(reactor_.now() + microseconds(step.duration_s));
      break;
    case Verb::kUntil:
      measured.value = wait_until(step, false);
      break;
    case Verb::kRecord:
      return record(step);
    case Verb::kPrompt:
      if (!(hooks_.prompt ? hooks_.prompt(step) : step.unattended == "continue"))
        throw EndRun(fmt::format("{}: \"{}\": answered with no", step.where, step.text));
      break;
  }
  return measured;
}

// recheck: after an interruption. If it still holds at the first look nothing has moved, and the run goes on
// at once.
double Runner::wait_until(const PlannedStep& step, bool recheck) {
  const std::int64_t deadline = reactor_.now() + microseconds(step.timeout_s);
  std::int64_t holds_since = -1;
  for (bool first = true;; first = false) {
    const double value = read(step);
    const std::int64_t now = reactor_.now();
    const bool holds = std::abs(value - step.near_si) <= step.within_si;
    if (recheck && first && holds) return value;
    if (!holds) holds_since = -1;
    if (holds && holds_since < 0) holds_since = now;
    if (holds && now - holds_since >= microseconds(step.duration_s)) return value;
    if (now >= deadline)
      throw InstrumentError(FaultKind::kTimeout, step.instrument,
                            fmt::format("{} = {:.4g} after {}: expected {:g} within {:g} for {}", step.name,
                                        value, show_duration(step.timeout_s), step.near_si, step.within_si,
                                        show_duration(step.duration_s)));
    reactor_.sleep_until(std::min(deadline, now + microseconds(step.poll_s)));
  }
}

Runner::Measured Runner::record(const PlannedStep& step) {
  const std::int64_t start = reactor_.now();
  for (const std::string& port : step.ports)
    instruments_.port(port).begin(step.channels, step.duration_s, step.join, step.keep);
  const auto complete = [&] {
    return std::ranges::all_of(step.ports,
                               [&](const std::string& port) { return instruments_.port(port).complete(); });
  };
  const std::int64_t end = start + microseconds(step.duration_s),
                     deadline = end + microseconds(step.timeout_s);
  bool all = reactor_.run_until(end, complete);
  // A slow port's last frame may be a whole period away, a fast one's is not: wait finely at first, then
  // coarsely.
  all = all || reactor_.run_until(std::min(deadline, end + microseconds(1)), complete) ||
        reactor_.run_until(std::min(deadline, end + microseconds(0.5)), complete,
                           microseconds(kRecordingSlice_s)) ||
        reactor_.run_until(deadline, complete, microseconds(1));
  Measured measured;
  for (const std::string& name : step.ports) {
    PortReader& port = instruments_.port(name);
    const bool whole = port.complete();
    RecordingRow row = port.finish();
    if (!whole)
      throw InstrumentError(
          FaultKind::kData, name,
          fmt::format("{} good frames, {} broken, {} of {} after {}", row.frames, row.broken,
                      show_duration(static_cast<double>(row.ticks) * sequence_.laboratory.unit.tick_s),
                      show_duration(step.duration_s), show_duration(step.duration_s + step.timeout_s)));
    row.tags = step.tags;
    judge(step, row, measured);
    measured.recordings.push_back(std::move(row));
  }
  return measured;
}

void Runner::judge(const PlannedStep& step, double value, Measured& measured) const {
  for (const Limit& limit : step.limits) {
    measured.limits += (measured.limits.empty() ? "" : "; ") + show(limit, value);
    if (!(value >= limit.low_si && value <= limit.high_si))
      measured.violation =
          InstrumentError(FaultKind::kOutOfRange, step.instrument, show(limit, value)).what();
  }
}

void Runner::judge(const PlannedStep& step, const RecordingRow& row, Measured& measured) const {
  for (const Limit& limit : step.limits) {
    double value = 0;
    if (limit.of == "lost")
      value = row.frames + row.lost > 0
                  ? static_cast<double>(row.lost) / static_cast<double>(row.frames + row.lost)
                  : 0;
    if (limit.of == "temperature") value = row.temperature;
    if (limit.of == "temperature_span") value = row.temperature_span;
    if ((limit.of == "current" || limit.of == "noise") && row.channels.empty()) continue;
    if (limit.of == "noise") value = row.channels.front().noise_A_sqrt_s;
    if (limit.of == "current") {
      const ChannelCounts& c = row.channels.front();
      const UnitDescription::Channel& design = *sequence_.laboratory.unit.channel(c.channel);
      value = (design.K_N0_C * static_cast<double>(c.N) - design.K_P0_C * static_cast<double>(c.P)) /
              (static_cast<double>(row.ticks) * sequence_.laboratory.unit.tick_s);
    }
    measured.limits += (measured.limits.empty() ? "" : "; ") + show(limit, value);
    if (!(value >= limit.low_si && value <= limit.high_si))
      measured.violation = InstrumentError(limit.of == "lost" ? FaultKind::kData : FaultKind::kOutOfRange,
                                           row.port, show(limit, value))
                               .what();
  }
}

void Runner::commit(const PlannedStep& step, StepOutcome outcome, const std::string& message,
                    std::int64_t started, Measured measured) {
  reactor_.sleep_until(reactor_.now());  // the simulated laboratory comes to rest before its state is kept
  StepRow row;
  row.index = step.index;
  row.attempt = attempts_[step.index];
  row.section = name_of(step.section);
  row.path = step.path;
  row.what = describe_action(step);
  row.where = step.where;
  row.outcome = outcome;
  row.message = message;
  row.started_utime = started;
  row.ended_utime = reactor_.now();
  row.value = measured.value;
  row.limits = measured.limits;
  for (RecordingRow& r : measured.recordings) {
    r.index = row.index;
    r.attempt = row.attempt;
  }
  ResumeState state;
  state.utime = row.ended_utime;
  if (hooks_.world_snapshot) state.world = hooks_.world_snapshot();
  for (const auto& [name, port] : instruments_.ports())
    if (!port->last_frame().empty()) state.last_frames[name] = port->last_frame();
  store_.commit(row, measured.recordings, std::exchange(trace_, {}), state);
}

// Whatever else fails, a disk that is full or a picture of the run: first all is made safe.
void Runner::tear_down(bool aborted) {
  std::exception_ptr failure;
  const auto try_to = [&failure](auto work) {
    try {
      work();
    } catch (const std::exception&) {
      if (!failure) failure = std::current_exception();
    }
  };
  for (std::size_t i = next_; i < sequence_.plan.size(); ++i) {
    const PlannedStep& step = sequence_.plan[i];
    if (step.section != Section::kTeardown) continue;
    const std::int64_t started = reactor_.now();
    std::string fault;
    Measured measured;
    try_to([&] { report(step); });
    for (int tries = 0; tries <= step.retries + 1; ++tries) {
      fault.clear();
      try {
        measured = attempt(step);
        break;
      } catch (const std::exception& error) {
        fault = error.what();
      }
    }
    ++attempts_[step.index];
    if (!fault.empty()) {
      alarm_ = fault;
      ++failures_;
    }
    const StepOutcome outcome = !fault.empty() ? StepOutcome::kFailed
                                : aborted      ? StepOutcome::kMadeSafe
                                               : StepOutcome::kDone;
    try_to([&] { commit(step, outcome, fault, started, std::move(measured)); });
  }
  for (const std::string& complaint : instruments_.make_safe()) {
    alarm_ = complaint;
    ++failures_;
  }
  if (failure) std::rethrow_exception(failure);
  if (hooks_.progress && !sequence_.plan.empty()) report(sequence_.plan.back());
}

void Runner::report(const PlannedStep& step) {
  if (!hooks_.progress) return;
  hooks_.progress({&step, sequence_.plan.size(), remaining_s_[static_cast<std::size_t>(step.index)],
                   reactor_.now(), failures_, alarm_});
}

}  // namespace waverig::rig::bench
