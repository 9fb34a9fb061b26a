// Time of a run that can be held and resumed: profile time against real time, eased by a raised cosine.
#pragma once
#include <optional>

#include "motion/limits.h"
#include "motion/profile.h"

namespace waverig::motion {

class RunClock {
 public:
  enum class State { kRunning, kSlowing, kHeld, kResuming };

  struct Reading {
    double profile_s = 0;
    double speed = 1;  // d profile / dt, and its derivatives
    double speed_1ps = 0;
    double speed_1ps2 = 0;
  };

  // t_s: seconds since the run's begin, never decreasing; ends an easing that is over.
  Reading read(double t_s);
  State state() const { return state_; }

  // Begins to slow down or to resume at t_s within ease_s. Only from kRunning and from kHeld.
  void hold(double t_s, double ease_s);
  void resume(double t_s, double ease_s);

 private:
  State state_ = State::kRunning;
  double begin_s_ = 0;  // of the state
  double begin_profile_s_ = 0;
  double ease_s_ = 0;
};

// What the arm does when the profile is read by the clock.
ProfilePoint eased(const RotationProfile& profile, const RunClock::Reading& reading);

// The shortest easing out of (or, with resuming, into) the profile at profile_s that stays inside the limits;
// nothing where none up to a minute does (in a ramp that already needs them whole).
std::optional<double> ease_s_within(const AxisLimits& limits, const RotationProfile& profile,
                                    double profile_s, bool resuming);

}  // namespace waverig::motion
