// AcquisitionNode: frame bytes in, raw counts and calibrated samples out on the bus.
#pragma once
#include <cstdint>
#include <span>

#include "lcmtypes/bus.h"
#include "rig/acquisition/acquisition.h"

namespace waverig::rig {

class AcquisitionNode {
 public:
  // A record begins with its first sample at or after the begin that record_t announces.
  AcquisitionNode(Bus& bus, Acquisition acquisition);
  void take(std::span<const std::uint8_t> bytes);
  const FrameStatistics& statistics() const { return acquisition_.statistics(); }

 private:
  Bus& bus_;
  Acquisition acquisition_;
};

}  // namespace waverig::rig
