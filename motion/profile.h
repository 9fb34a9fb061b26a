// Rotation profile of the arm: rest, ramp in, steady turning, ramp out, rest. Closed form in time.
//
// The angular rate follows a raised cosine over whole wave periods, so both ramps together turn the arm by
// whole turns: with an even number of ramp periods it starts, enters the steady part and stops at one angle.
#pragma once
#include "lcmtypes/phase.h"

namespace waverig::motion {

struct ProfileSettings {
  double period_s = 6;        // of the wave: one turn of the arm
  double steady_s = 300;      // rounded up to whole periods
  int ramp_periods = 2;       // of each ramp, at least 1
  double rest_before_s = 10;  // at rest the estimator can learn its gyro bias
  double rest_after_s = 2;
  int direction = 1;           // +1 lifts the sensor first, -1 turns the other way
  double rate_modulation = 0;  // relative depth, of the steady part, mean zero
  int modulation_cycles = 0;   // whole cycles over the steady part
  double rate_drift = 0;       // relative change of the rate from the steady part's begin to its end
};

struct ProfilePoint {
  double angle_rad = 0;  // from the angle at which the run began
  double rate_radps = 0;
  double accel_radps2 = 0;
  double jerk_radps3 = 0;
  Phase phase = Phase::kRest;
};

// Upper bounds of the magnitudes over the whole profile, attained where modulation and drift are zero.
struct ProfilePeaks {
  double rate_radps = 0;
  double accel_radps2 = 0;
  double jerk_radps3 = 0;
};

class RotationProfile {
 public:
  // Throws UserError, naming the value, where a setting makes no profile.
  explicit RotationProfile(const ProfileSettings& settings);

  // t_s from the begin of the profile; before it as at 0, after it as at the end.
  ProfilePoint at(double t_s) const;
  ProfilePeaks peaks() const;

  const ProfileSettings& settings() const { return settings_; }
  int steady_periods() const { return steady_periods_; }
  double ramp_begin_s() const { return settings_.rest_before_s; }
  double steady_begin_s() const { return ramp_begin_s() + ramp_s_; }
  double steady_end_s() const { return steady_begin_s() + steady_s_; }
  double ramp_end_s() const { return steady_end_s() + ramp_s_; }
  double duration_s() const { return ramp_end_s() + settings_.rest_after_s; }

 private:
  ProfilePoint ramp(double tau_s, double rate_radps) const;
  ProfilePoint steady(double tau_s) const;

  ProfileSettings settings_;
  int steady_periods_ = 0;
  double rate_radps_ = 0;      // 2 pi / T, signed by the direction
  double end_rate_radps_ = 0;  // at the end of the steady part
  double ramp_s_ = 0;
  double steady_s_ = 0;
  double steady_begin_rad_ = 0;
  double steady_end_rad_ = 0;
  double end_rad_ = 0;
};

}  // namespace waverig::motion
