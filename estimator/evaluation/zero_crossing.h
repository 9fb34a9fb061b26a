// Zero-up-crossing waves of a heave series and their statistics.
//
// A wave reaches from one up-crossing of the zero line to the next; its height is highest minus lowest heave
// between. A sample on the zero line counts as above it. H1/n and T1/n are means over exactly the n-th part
// of the waves: where that is no whole number, the last wave counts with the fraction that is left. Held
// against twelve half hours of a Datawell Waverider this reproduces the buoy's own Hmax, H1/3, H1/10 and mean
// height to the last digit, given the buoy's zero line: the mean of the half hour before.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/types.h"

namespace waverig::evaluation {

struct ZeroCrossingSettings {
  bool remove_mean = true;    // the zero line is the series' mean …
  bool remove_trend = false;  // … or its straight line of least squares
  double level_m = 0;         // … and this much above it
  double dead_band_m = 0;     // a crossing counts once the heave has left +- this band on the other side
  bool interpolate_extremes =
      false;  // crest and trough by a parabola through three samples; else the samples' own
};

struct CountedWave {
  std::int64_t start_utime = 0;  // interpolated crossing
  double period_s = 0;
  double height_m = 0;                   // crest to trough
  double crest_m = 0;                    // above the zero line
  double trough_m = 0;                   // below it, negative
  double sigma_m = estimator::kUnknown;  // standard uncertainty of the height, where the heave's is stated
};

// utime in microseconds, growing; heave in metres, up; NaN is a gap, and so is a step of more than three
// median intervals: no wave reaches over one. Both of one length, as is what the heave states of its standard
// uncertainty (k = 1), unless that is empty.
//
// Of a stated sigma nobody tells how much is noise and how much goes with the heave, as a wrong scale does,
// which lifts the crest and sinks the trough. So the height is given the sum of both sigmas, the most that it
// can be wrong by, and waves_of() carries it as common to all waves: it does not become less with their
// number (GUM 5.2.2, note 1: correlation unknown and taken as one). Where nothing is stated, nothing is
// known.
std::vector<CountedWave> count_waves(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                                     const ZeroCrossingSettings& settings = {},
                                     std::span<const double> heave_sigma_m = {});

// The same as single waves of a method.
std::vector<estimator::Wave> waves_of(std::span<const CountedWave> counted);

struct WaveStatistics {
  std::int64_t waves = 0;
  double mean_height_m = estimator::kUnknown, std_height_m = estimator::kUnknown, h13_m = estimator::kUnknown,
         h110_m = estimator::kUnknown, hmax_m = estimator::kUnknown;
  double mean_period_s = estimator::kUnknown;  // Tz, counted
  double t13_s = estimator::kUnknown;          // mean period of the highest third
};

WaveStatistics statistics_of(std::span<const CountedWave> waves);

}  // namespace waverig::evaluation
