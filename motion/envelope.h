// Judges a setting before anything moves: what cannot be made, cannot be at sea, or cannot be measured.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "motion/limits.h"

namespace waverig::motion {

enum class EnvelopeReason { kBeyondRig, kBreaks, kClips, kBelowNoise };
enum class Verdict { kWarn, kRefuse };

std::string_view name_of(EnvelopeReason reason);  // "beyond the rig", "breaks", "clips", "below noise"

// Zero switches the judgement off that needs the number.
struct EnvelopeSettings {
  double min_radius_m = 0.05;  // of the arm, adjustable in a set-up step
  double max_radius_m = 1.5;
  AxisLimits limits{};
  double max_centripetal_mps2 = 0;     // what arm and gondola bear: w^2 r
  double sensor_range_mps2 = 0;        // full scale of one accelerometer axis, e.g. 4 g
  double noise_mps2_sqrtHz = 0;        // one-sided amplitude density
  double drift_mps2 = 0;               // bias drift expected over a run
  double noise_warn_fraction = 0.1;    // single-wave height sigma over height: warn above this,
  double noise_refuse_fraction = 0.5;  // refuse above this
  Verdict breaking = Verdict::kWarn;   // the rig can turn a wave that no sea carries
};

struct Judgement {
  EnvelopeReason reason;
  Verdict verdict;
  std::string sentence;  // with the numbers
};

inline constexpr double kBreakingSteepness = 1.0 / 7;  // H/L in deep water, Michell 1893, rounded as usual

double deep_water_length_m(double period_s);                      // L = g T^2 / 2 pi
double peak_acceleration_mps2(double period_s, double height_m);  // w^2 H / 2
// REFERENCE section 3: sigma_H >= (2 / w^2) nd / sqrt(T), of one wave.
double height_sigma_bound_m(double period_s, double noise_mps2_sqrtHz);

// All that can be said against the setting, in the order of EnvelopeReason; empty: run it.
// ramp_periods as in ProfileSettings: it decides acceleration and jerk.
std::vector<Judgement> judge(double period_s, double height_m, int ramp_periods,
                             const EnvelopeSettings& settings);

}  // namespace waverig::motion
