// Method: one way from samples to heave and waves, chosen by name. It sees samples and its settings, nothing
// else: no setting of the rig, no truth, no seed, no clock.
#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/compass/magnetic_calibration.h"
#include "estimator/types.h"

namespace waverig::estimator {

// What a laboratory knows of its sensor beforehand (data sheet and calibration certificate), for the
// uncertainty budget. Standard uncertainties, k = 1. The defaults are a fresh six-position calibration of a
// data-sheet part.
struct SensorKnowledge {
  double gravity_mps2 = kStandardGravity;  // at the place of measurement
  double gravity_sigma_mps2 = 0.015;    // how well it is known; small: the mean |f| then tells scale and bias
  double accel_bias_sigma_mps2 = 2e-3;  // what the calibration leaves, per axis, ageing included
  double accel_scale_sigma = 3e-4;      // relative
  double accel_misalignment_sigma_rad = 3e-4;
  double accel_slope_sigma = 0;  // relative; slope at 1 g against the chord from -1 g to 1 g
  double gyro_bias_sigma_radps = 0.2 * kDegree;
  double gyro_scale_sigma = 0.01;  // relative

  // Relative, of what varies about 1 g.
  double wave_scale_sigma() const { return std::hypot(accel_scale_sigma, accel_slope_sigma); }
};

struct MethodSettings {
  SensorKnowledge sensor;
  CompassSettings compass{};  // used where samples carry a magnetic field
  double fixed_lag_s = 0;     // for methods that may answer late: of heave behind its newest sample
};

// Receives what a method finds; a method may call it at any time during add() and finish().
class Output {
 public:
  virtual ~Output() = default;
  virtual void heave(const HeaveSample&) {}
  virtual void wave(const Wave&) {}
  virtual void sea(const SeaState&) {}
  virtual void offset_change(const OffsetChange&) {}
};

class Method {
 public:
  virtual ~Method() = default;
  virtual void add(const ImuSample& sample, Output& output) = 0;
  virtual void finish(Output& output) = 0;  // the record ends: give what is still held back
};

// Throws UserError for an unknown name, naming the known ones, and for a lag that the method does not know.
std::unique_ptr<Method> make_method(std::string_view name, const MethodSettings& settings);
std::vector<std::string> method_names();
// One of ours that tells its waves itself: where it tells none it found none.
bool tells_waves(std::string_view name);

}  // namespace waverig::estimator
