// One wave fitted to levelled vertical acceleration: harmonic, second harmonic, offset and drift at a given
// frequency.
#pragma once
#include <Eigen/Core>

#include "estimator/waves/wave_series.h"

namespace waverig::estimator {

struct WaveFit {
  bool valid = false;
  double begin_s = 0, end_s = 0, middle_s = 0, omega_radps = 0;
  double cos_mps2 = 0, sin_mps2 = 0;  // a = cos_ cos(w tau) + sin_ sin(w tau), tau from the middle
  double second_mps2 = 0;             // amplitude at twice the frequency
  double offset_mps2 = 0;             // at the middle
  double noise_density = 0;      // one-sided amplitude density of the residual near the wave, m/s^2/sqrt(Hz)
  double misfit_mps2 = 0;        // rms of the residual in blocks of a twenty-fourth of the wave
  double sigma_per_density = 0;  // standard deviation of cos_ or sin_ for unit noise density
  double coverage = 0;           // part of the wave with data

  double amplitude_mps2() const { return std::hypot(cos_mps2, sin_mps2); }
  // Zero-down-crossing of the heave nearest to the middle: a = R sin(w (t - d)).
  double down_crossing_s() const { return middle_s - std::atan2(cos_mps2, sin_mps2) / omega_radps; }
};

// slope_mps3: drift of the acceleration, known from the neighbouring waves (within one wave from up-crossing
// to up-crossing it would look much like the wave's own sine and cost 60 % in scatter).
WaveFit fit_wave(const WaveSeries& series, double begin_s, double end_s, double omega_radps,
                 double slope_mps3);

}  // namespace waverig::estimator
