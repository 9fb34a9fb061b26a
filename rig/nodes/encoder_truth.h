// EncoderTruth: what a real arm did, by its encoder: heave = r sin(angle), the drive's zero being the
// horizontal arm. Where the gondola hangs it is taken to hang plumb: how it swings the encoder does not see,
// and the sensor, a lever l below the pivot, lies l (1 - cos swing) higher than told. The simulated rig tells
// its own truth, swing included.
#pragma once
#include <cstdint>

#include "lcmtypes/bus.h"
#include "motion/kinematics/body_motion.h"

namespace waverig::rig {

struct ArmPlacement {
  double radius_m = 0;
  double azimuth_rad = 0;  // where the arm points at angle 0, from north to east
};

class EncoderTruth {
 public:
  EncoderTruth(Bus& bus, const ArmPlacement& arm);
  // What the encoder read at utime, later than the last.
  void tell(std::int64_t utime, double measured_rad);

 private:
  Bus& bus_;
  ArmPlacement arm_;
  Quaterniond q_azimuth_;
  std::int64_t last_utime_ = 0, seq_ = 0;
  double last_rad_ = 0;
};

}  // namespace waverig::rig
