// SimulatedSea: a buoy that floats on an irregular sea, in place of arm and drive: the same sensors, front
// end and frames.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/bus.h"
#include "motion/sea_state.h"
#include "rig/frontend/simulated_unit.h"
#include "rig/nodes/run_announcer.h"

namespace waverig::rig {

struct SimulatedSeaSettings {
  motion::SeaSettings sea;
  motion::FloatSettings buoy;
  UnitSettings unit;
  double duration_s = 1200;
  double step_s = 2e-3;  // of buoy and sensors
  std::uint64_t noise_seed = 1;
};

class SimulatedSea {
 public:
  // Announces the record, all of it steady, from start_utime on.
  SimulatedSea(Bus& bus, const SimulatedSeaSettings& settings, const UnitParameters& unit,
               std::int64_t start_utime, const OrderedRun& ordered);

  bool finished() const { return finished_; }
  // Lets a time pass and publishes the truth at its end; the bytes stay valid until the next call.
  std::span<const std::uint8_t> advance(double duration_s);

 private:
  Bus& bus_;
  SimulatedSeaSettings settings_;
  motion::SeaMotion buoy_;
  SimulatedUnit unit_;
  RunAnnouncer announce_;
  std::int64_t utime_, end_utime_;
  std::int64_t truth_seq_ = 0;
  bool finished_ = false;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace waverig::rig
