// Strapdown navigator: from increments of angle and velocity, as an integrating converter counts them, to
// attitude, velocity and place on the turning Earth. Coning and sculling are compensated.
#pragma once
#include "motion/kinematics/earth.h"

namespace waverig {

// Integrals over one sampling interval in the body frame: the plain sums of w_ib^b and f^b.
struct Increments {
  Vector3d angle_B = Vector3d::Zero();     // rad
  Vector3d velocity_B = Vector3d::Zero();  // m/s
  double dt_s = 0;
};

struct NavigationState {
  Place place;
  Vector3d velocity_N = Vector3d::Zero();  // m/s, against the Earth
  Quaterniond q_NB = Quaterniond::Identity();
};

// Integrates Lee-HK, eq. (28). Nothing damps it: errors oscillate with the Schuler period in the horizontal
// channels and grow with sqrt(R / 2 g) = 570 s in the vertical one, as physics has it for a free inertial
// navigator.
class StrapdownNavigator {
 public:
  explicit StrapdownNavigator(const NavigationState& initial, const EarthConstants& earth = kWgs84)
      : earth_(earth), state_(initial) {}

  // dt_s may change from call to call; an interval without length changes nothing. Throws UserError at a
  // pole.
  void add(const Increments& increments);
  const NavigationState& state() const { return state_; }

 private:
  EarthConstants earth_;
  NavigationState state_;
  Increments previous_;
};

}  // namespace waverig
