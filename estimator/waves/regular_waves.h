// Regular waves of one stretch of levelled acceleration: found, timed, fitted, with their uncertainty.
#pragma once
#include <vector>

#include "estimator/method.h"
#include "estimator/waves/wave_finder.h"
#include "estimator/waves/wave_fit.h"
#include "estimator/waves/wave_timing.h"

namespace waverig::estimator {

struct RegularWaveSettings {
  WaveFinderSettings finder;
  double least_snr = 4.5;        // amplitude over its noise: what does not reach it is no wave
  double clear_snr = 6;          // what does not reach this is flagged
  double timing_floor = 1e-4;    // of a period: crossings of a real rig are no better than this
  double settled_period = 0.03;  // a wave differing more from its neighbours' spacing is settling
  double settled_misfit = 0.08;  // rms of the residual over the amplitude, beyond noise
};

struct RegularWave {
  WaveFit fit;  // final, at the shared frequency
  WaveTiming timing;
  bool follows = false;      // the wave before ends where this one begins
  double noise_density = 0;  // pooled over the neighbours, m/s^2/sqrt(Hz)
  double height_m = 0;
  double noise_sigma_m = 0, calibration_sigma_m = 0, tilt_sigma_m = 0, frequency_sigma_m = 0;
  // Of heave, beyond the height's: where the wave is no sine, and where heights do not change evenly.
  double shape_sigma_m = 0, corner_sigma_m = 0;
  std::int32_t flags = 0;

  double begin_s() const { return timing.down_crossing_s - 0.5 * timing.period_s; }
  double end_s() const { return timing.down_crossing_s + 0.5 * timing.period_s; }
};

// Whole waves near the given period inside the series, in order of time.
std::vector<RegularWave> regular_waves(const WaveSeries& series, double period_s,
                                       const RegularWaveSettings& settings, const SensorKnowledge& knowledge);

}  // namespace waverig::estimator
