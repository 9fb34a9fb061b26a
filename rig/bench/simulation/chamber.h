// The temperature chamber: set point (at once or as a ramp), controller and air, second order with overshoot.
#pragma once
#include <cstdint>

namespace waverig::rig::bench {

struct ChamberTruth {
  double ambient_degC = 23;
  double natural_period_s = 1500;     // of the controlled air
  double damping = 0.45;              // below 1: it overshoots
  double rate_max_degC_s = 3.0 / 60;  // heater and compressor
  double ripple_degC = 0.03;          // the controller never rests
  double ripple_period_s = 400;
  double idle_time_constant_s = 3600;  // off: back to ambient
};

struct ChamberControls {  // what it has been told
  bool on = false;
  double target_degC = 23;
  double ramp_degC_s = 0;   // 0: as fast as it can
  double hunting_degC = 0;  // a fault: the controller hunts about its set point by this much
};

struct ChamberState {
  double setpoint_degC = 23;  // the ramp's present value
  double air_degC = 23;
  double rate_degC_s = 0;
  double time_s = 0;
};

void advance(const ChamberTruth& truth, const ChamberControls& controls, ChamberState& state, double dt_s);

}  // namespace waverig::rig::bench
