// The simulation of Cho, section III.4: how an accelerometer's errors reach roll, pitch and heading, how much
// of it the linear formulas tell, and how well a level turn tells the dip and two axes tell the third. With
// any number of runs; the same result for any number of threads.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/compass/heading.h"

namespace waverig::estimator {

struct TiltStudySettings {
  std::int64_t runs = 100;  // at least 2
  int least_repeats = 100;  // experiments of the document's size behind the repeat intervals; at least 2
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all cores
  double dip_rad = 50 * kDegree;
  double accel_error_sigma_mps2 = 1;  // a constant a run and axis
  double accel_noise_mps2 = 1e-3;     // white
  double field_noise = 1e-3;          // white, of the normalised field
  double sweep_rad = 50 * kDegree;    // roll and pitch together, from minus to plus
  int sweep_points = 1001;
  int turn_points = 361;  // of the level turn that tells the dip
  std::array<double, 2> heading_rad{45 * kDegree,
                                    -135 * kDegree};  // case I and case II; they share their noise
  double gravity_mps2 = kStandardGravity;
};

// What is followed along the sweep. "Miss" is the error less what a linear formula says of it.
enum class Quantity {
  kRoll,
  kPitch,
  kHeading1,
  kHeading2,
  kRollMiss,      // of eq. (28)
  kPitchMiss,     // of eq. (32)
  kHeading1Miss,  // of eq. (38) fed with the true tilt errors, as the document does
  kHeading2Miss,
  kCount
};
inline constexpr int kQuantities = static_cast<int>(Quantity::kCount);

// Over the runs, at each point of the sweep; radians.
struct Curve {
  std::vector<double> mean, std;
  std::vector<double> mean_sigma, std_sigma;  // standard errors of both
};

// One run, for the pictures that show one. Radians but z.
struct ExampleRun {
  std::array<std::vector<double>, 4> computed;  // roll, pitch, heading I, heading II
  std::array<std::vector<double>, 4> error;
  std::array<std::vector<double>, 4> predicted;  // by eqs. (28), (32), (38)
  std::vector<double> z_true, z_estimated;       // two-axis module, case I
  std::vector<double> turn_heading, turn_dip;    // level turn
};

// A figure of the document beside its reproduction. Interval: 95 %.
struct Interval {
  double low = 0, high = 0;
  bool contains(double x) const { return x >= low && x <= high; }
};
struct StudyFigure {
  std::string name;
  std::string unit;  // "deg" or "1"
  double published = 0;
  Interval repeats;     // where 95 % of experiments of the document's size fall
  double value = 0;     // of all the runs asked for
  Interval confidence;  // of value
};

struct TiltStudy {
  TiltStudySettings settings;
  std::vector<double> tilt_rad;
  std::array<Curve, kQuantities> curves;
  ExampleRun example;
  std::vector<StudyFigure> figures;
};

// Throws UserError where runs, points or a sigma make no sense.
TiltStudy run_tilt_study(const TiltStudySettings& settings);

}  // namespace waverig::estimator
