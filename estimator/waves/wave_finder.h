// Finding single waves without knowing the setting: the dominant period of a stretch of record, then the
// zero-up-crossings of the heave in a band around it.
#pragma once
#include <optional>
#include <vector>

#include "estimator/waves/wave_series.h"

namespace waverig::estimator {

struct WaveFinderSettings {
  double shortest_period_s = 0.9;
  double longest_period_s = 25;
  double significance = 25;  // of a spectral line above the median of the spectrum
};

struct WaveSpan {
  double begin_s = 0, end_s = 0;  // zero-up-crossings of the heave
  bool follows = false;           // begins where the span before ends
};

// Period of the strongest line of a/w (velocity) that stands out of the noise; nothing where none does.
std::optional<double> dominant_period_s(const WaveSeries& series, const WaveFinderSettings& settings);

// Whole waves of roughly this period, from the phase of a sliding local fit of harmonic, offset and drift,
// the sight being under four periods long. Waves much longer or shorter than the period (a starting rig) are
// not seen.
std::vector<WaveSpan> find_waves(const WaveSeries& series, double period_s);

}  // namespace waverig::estimator
