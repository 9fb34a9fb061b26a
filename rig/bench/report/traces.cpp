#include "rig/bench/report/traces.h"

#include <limits>

#include "motion/kinematics/frames.h"
#include "rig/bench/port_reader.h"

namespace waverig::rig::bench {

Traces::Traces(const UnitDescription& unit, const FrameLayout& counts_layout)
    : unit_(unit),
      layout_(counts_layout),
      ticks_(layout_.index_of("ticks")),
      temperature_(layout_.index_of("temperature")) {
  for (const UnitDescription::Channel& c : unit_.channels) current_A_[c.name];
}

void Traces::add(const TraceRow& row) {
  if (row.port != unit_.counts_port || row.raw.size() != layout_.fields.size()) return;
  time_s_.push_back(static_cast<double>(row.utime) * kMicrosecond);
  temperature_degC_.push_back(layout_.fields[temperature_].value(row.raw[temperature_]));
  // A unit that began anew counts from zero: its totals seem to have wrapped.
  constexpr std::int64_t kDayOfTicks = 8'640'000;
  const std::int64_t ticks = last_.empty() ? 0 : total_step(layout_, last_, row.raw, ticks_);
  for (const UnitDescription::Channel& c : unit_.channels) {
    double current_A = std::numeric_limits<double>::quiet_NaN();
    if (ticks > 0 && ticks < kDayOfTicks) {
      const auto total = [&](const char* suffix) {
        return static_cast<double>(total_step(layout_, last_, row.raw, layout_.index_of(c.name + suffix)));
      };
      current_A =
          (c.K_N0_C * total("_N") - c.K_P0_C * total("_P")) / (static_cast<double>(ticks) * unit_.tick_s);
    }
    current_A_[c.name].push_back(current_A);
  }
  last_ = row.raw;
}

Traces traces_of(const Sequence& sequence, const Store& store) {
  Traces traces(sequence.laboratory.unit,
                sequence.laboratory.port(sequence.laboratory.unit.counts_port)->layout);
  for (const TraceRow& row : store.trace()) traces.add(row);
  return traces;
}

}  // namespace waverig::rig::bench
