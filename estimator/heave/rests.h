// Rests within a record of waves: the board before a run and after it, a buoy on deck.
//
// A body rests where over a mean wave period its speed is that of a steady acceleration, which is the
// sensor's offset, but for the sensor's noise and a few per cent of the sea's heave rate. Waves are seldom so
// low for so long even between two groups; half a period of such instants is asked for.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace waverig::estimator {

struct Rests {
  // A node each: the body rests; it is being set in motion or brought to rest, from a rest on until it moves
  // as the sea does over the whole of a period.
  std::vector<bool> still, between;
  bool any() const { return std::find(still.begin(), still.end(), true) != still.end(); }
};

struct Pace {           // of a sea
  double rate_mps = 0;  // standard deviation of the heave rate
  double period_s = 0;  // mean period
};

// Speed about its line of a body at rest, over the sea's heave rate.
inline constexpr double kStillRate = 0.03;

// speed_mps: int a dt at nodes interval_s apart; accel_noise_m2ps3: two-sided density.
Rests find_rests(const Eigen::VectorXd& speed_mps, double interval_s, const Pace& sea,
                 double accel_noise_m2ps3);

}  // namespace waverig::estimator
