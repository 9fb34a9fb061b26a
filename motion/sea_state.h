// Irregular seas as a sum of many linear deep-water components, and the motion of a body that floats on them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "motion/kinematics/body_motion.h"
#include "motion/spectrum.h"

namespace waverig::motion {

struct SeaSettings {
  SpectrumShape shape = SpectrumShape::kJonswap;
  double hm0_m = 1.5;
  double tp_s = 8;
  double gamma = 3.3;
  double direction_from_rad = 0;  // true
  double spreading_s = 0;         // cos^2s((theta - theta0)/2), Longuet-Higgins et al. 1963; 0: long-crested
  int components = 400;
  double lowest_relative = 0.5;  // of the peak frequency
  double highest_relative = 5;
  bool random_amplitudes = false;  // Rayleigh distributed (a true Gaussian sea), else from the spectrum
  bool exact_hm0 = true;           // components scaled so that 4 sqrt(m0) = hm0_m exactly
  std::uint64_t seed = 1;
};

// surface(t) = amplitude cos(w t + phase) at the mean position; the wave runs towards `towards_rad`.
struct WaveComponent {
  double w_radps = 0;
  double amplitude_m = 0;
  double phase_rad = 0;
  double towards_rad = 0;  // true
};

// Frequencies are drawn one in each of equal bands, so that the sea does not repeat; directions are one in
// each of equal shares of the spreading, far apart in neighbours, the energy's mean exactly as set. Throws
// UserError where a setting makes no sea.
std::vector<WaveComponent> draw_components(const SeaSettings& settings);

// Of the components as they are: exact, no sampling scatter.
SeaMoments moments_of(const std::vector<WaveComponent>& components);

// How the body takes the waves; zero switches the effect off.
struct FloatSettings {
  double slope_following = 1;  // tilt over wave slope: 1 a flat disc, 0 stays level
  double heading_rad = 0;
  double tilt_rad = 0;  // more tilting: roll and pitch, a quarter period apart
  double tilt_period_s = 0;
  double heading_wander_rad = 0;  // slow turning to and fro
  double heading_wander_period_s = 0;
  std::int64_t start_utime = 0;  // t = 0 of the components
  std::uint64_t seed = 1;        // phases of tilting and wandering
};

// Linear orbital motion at the mean position and slope-following tilt, with exact rates.
//
// All components are summed at knots some 20 times a second and joined by quintic polynomials through
// position, velocity and acceleration: what it answers is one smooth motion whose velocity, acceleration and
// angular rate are the derivatives of its position and attitude. It departs from the sum by less than 1e-6 of
// it. Answers do not depend on the order of the questions, but are fast in ascending time.
class SeaMotion {
 public:
  SeaMotion(std::vector<WaveComponent> components, const FloatSettings& settings);

  BodyMotion at(std::int64_t utime);
  const std::vector<WaveComponent>& components() const { return components_; }
  double knot_s() const { return knot_s_; }

 private:
  static constexpr std::size_t kKnots = 128;  // a block
  // Knot values by channel: heave, north and east with their first two derivatives; the slopes' are the third
  // and fourth of the horizontal ones over -g.
  enum Channel : std::size_t {
    kUp,
    kUp1,
    kUp2,
    kNorth,
    kNorth1,
    kNorth2,
    kNorth3,
    kNorth4,
    kEast,
    kEast1,
    kEast2,
    kEast3,
    kEast4,
    kChannels
  };
  struct Quintic {
    std::array<double, 6> c{};
  };

  void fill_block(std::int64_t block);
  void load_interval(std::int64_t interval);
  Quintic join(std::size_t index, Channel value, Channel first, Channel second, double factor) const;

  std::vector<WaveComponent> components_;
  FloatSettings settings_;
  double tilt_phase_rad_ = 0, wander_phase_rad_ = 0;
  std::int64_t knot_us_ = 0;
  double knot_s_ = 0;

  std::int64_t block_ = -1, interval_ = -1;
  bool filled_ = false;
  std::array<std::array<double, kKnots + 1>, kChannels> knots_{};
  Quintic up_, north_, east_, north_slope_, east_slope_;
};

}  // namespace waverig::motion
