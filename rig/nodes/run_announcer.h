// Says on the bus what was ordered, which phase begins and where a record begins and ends.
#pragma once
#include <cstdint>

#include "lcmtypes/bus.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {

struct OrderedRun {
  double period_s = 0;
  double height_m = 0;
  int repeat = 0;
};

class RunAnnouncer {
 public:
  RunAnnouncer(Bus& bus, const OrderedRun& ordered) : bus_(bus), ordered_(ordered) {}
  void phase(std::int64_t utime, Phase phase);  // nothing where it goes on
  void record(std::int64_t utime, RecordAction action);

 private:
  Bus& bus_;
  OrderedRun ordered_;
  Phase phase_ = Phase::kStopped;
  std::int64_t run_seq_ = 0, record_seq_ = 0;
};

}  // namespace waverig::rig
