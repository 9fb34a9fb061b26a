#include "rig/nodes/run_announcer.h"

#include <waverig/record_t.hpp>
#include <waverig/run_t.hpp>

#include "lcmtypes/channels.h"

namespace waverig::rig {

void RunAnnouncer::phase(std::int64_t utime, Phase phase) {
  if (phase == phase_) return;
  phase_ = phase;
  run_t m{};
  m.utime = utime;
  m.seq = run_seq_++;
  m.phase = static_cast<std::int32_t>(phase);
  m.repeat = ordered_.repeat;
  m.period_s = ordered_.period_s;
  m.height_m = ordered_.height_m;
  bus_.publish(channel::kRun, m);
}

void RunAnnouncer::record(std::int64_t utime, RecordAction action) {
  record_t m{};
  m.utime = utime;
  m.seq = record_seq_++;
  m.action = static_cast<std::int32_t>(action);
  bus_.publish(channel::kRecord, m);
}

}  // namespace waverig::rig
