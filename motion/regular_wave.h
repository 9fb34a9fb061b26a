// One regular wave in closed form, with what real ones have: amplitude modulation, slow frequency change,
// tilting.
#pragma once
#include <cstdint>

#include "motion/kinematics/body_motion.h"

namespace waverig::motion {

// Zero switches the effect off.
struct RegularWaveSettings {
  double period_s = 6;
  double height_m = 1;              // crest to trough
  double amplitude_modulation = 0;  // relative: amplitude (1 + m sin(2 pi t / Tm))
  double modulation_period_s = 0;
  double frequency_drift_1ps = 0;  // relative change of the frequency per second
  double orbit_ratio = 1;          // horizontal over vertical amplitude: 1 a circle, 0 heave only
  double towards_rad = 0;          // true
  double tilt_rad = 0;             // pitching at the wave's frequency, in phase with the slope
  double heading_rad = 0;
  double phase_rad = 0;  // 0: t = 0 at a crest
  std::int64_t start_utime = 0;
};

class RegularWave {
 public:
  // Throws UserError, naming the value.
  explicit RegularWave(const RegularWaveSettings& settings);
  BodyMotion at(std::int64_t utime) const;

 private:
  RegularWaveSettings settings_;
};

}  // namespace waverig::motion
