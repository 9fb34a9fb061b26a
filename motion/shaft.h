// What the simulated drive's shaft really does; the mechanism hangs on it. Never seen by the controller.
#pragma once

namespace waverig::motion {

struct ShaftState {
  double angle_rad = 0;  // at the arm, after the gear; 0 = arm horizontal, growing lifts the sensor first
  double rate_radps = 0;
  double accel_radps2 = 0;
};

}  // namespace waverig::motion
