// What errors of the accelerometer's calibration do to one wave's amplitude, through the geometry of that
// very wave.
//
// Twelve parameters p: the nine elements of E and the three of b in f_m = f + E f + b (Lee 2014, eq. (1),
// what the calibration left). Each makes the error e_B = E f + b, seen in the levelled vertical as
//     e_up = up . R e_B + (mean horizontal of R e_B) . a_h / g
// the second term because the attitude is levelled with the same accelerometer. Its part in phase with the
// wave is the sensitivity of the amplitude; its mean is the sensitivity of the mean vertical specific force,
// which must be g: one equation between the parameters that a record gives for nothing, used as a Bayesian
// update. Level, only scale matters. Tilting with the wave, (m_xz + m_zx + b_x / g) times the horizontal
// specific force.
#pragma once
#include "estimator/method.h"
#include "estimator/waves/wave_fit.h"

namespace waverig::estimator {

struct AmplitudeBudget {
  double correction_mps2 = 0;         // to be taken off the amplitude: what the mean vertical force tells
  double calibration_sigma_mps2 = 0;  // as if level
  double tilt_sigma_mps2 = 0;         // what tilting at the wave's frequency adds
};

// fit: of the wave. mean_up_mps2, mean_up_sigma_mps2: mean levelled vertical acceleration over whole waves
// around it.
AmplitudeBudget amplitude_budget(const WaveSeries& series, const WaveFit& fit,
                                 const SensorKnowledge& knowledge, double mean_up_mps2,
                                 double mean_up_sigma_mps2);

}  // namespace waverig::estimator
