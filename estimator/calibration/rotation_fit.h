// Calibration of an accelerometer from a record of slow rotation through many attitudes, for real units that
// nobody could put into six positions: without linear acceleration |f| = g whatever the attitude.
//
// A hand does accelerate what it turns. So the readings of a window are first carried into one frame by the
// gyroscope and averaged there: what is left of the acceleration is the change of velocity over the window's
// length, and seconds are long enough. No window spans a gap (sample_steps.h). |mean of R_k A (f_m - b)| = g,
// A = M^-1, is then fitted over all windows. It holds for any rotation of f, so M is found up to a rotation:
// the one that leaves it symmetric, the nearest to the sensor's own axes, is taken (9 unknowns).
#pragma once
#include <span>

#include "estimator/calibration/accelerometer_calibration.h"
#include "estimator/types.h"

namespace waverig::estimator {

struct RotationFitSettings {
  double window_s = 4;               // half overlapping
  double rest_scatter_radps = 0.01;  // a window whose angular rate scatters less is at rest
  double outlier_mps2 = 0.03;        // residuals beyond it count less (Huber)
  int fewest_windows = 20;
};

struct RotationFit {
  AccelerometerCalibration
      calibration;                 // covariance from the residuals; a rotation of M is not seen, nor counted
  GyroscopeCalibration gyroscope;  // from the windows at rest; not a number where there were none (0 assumed)
  int windows = 0;
  double residual_rms_mps2 = 0;     // of |f| - g over the windows, after the fit
  double residual_before_mps2 = 0;  // and with the readings as they are
  double coverage = 0;  // 3 x smallest eigenvalue of the mean of u u^T: 1 for even attitudes, 0 a plane
};

// Samples by nominal sensitivities. Throws UserError where windows or attitudes are too few.
RotationFit fit_rotation(std::span<const ImuSample> samples, double gravity_mps2,
                         const RotationFitSettings& settings = {});

}  // namespace waverig::estimator
