// Six-position calibration of an accelerometer, Lee 2014, eq. (1) and Table 1: each axis up and down gives 18
// equations for the 12 unknowns of M and b, solved by least squares.
//
// With the bend as well, one more unknown an axis, the difference between the level readings and the mean of
// up and down is no longer a residual; 15 unknowns leave 3 equations to check with.
//
// Two things make it uncertain: the scatter of each position's mean, and the angle by which the fixture
// misses the position. The angle d shows as M (f x d): first order across the axis, second order along it.
// The covariance follows from both (the misses of a position are common to its three equations).
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "estimator/calibration/accelerometer_calibration.h"
#include "motion/kinematics/frames.h"

namespace waverig::estimator {

// The sensor at rest with one body axis upright.
struct StaticPose {
  int axis = 2;      // 0, 1, 2: x, y, z of the body
  double sign = -1;  // +1: the axis points up, so that its specific force is +g
  std::string_view name;
};

// Lee 2014, Table 1.
inline constexpr std::array<StaticPose, 6> kSixPositions{{{0, +1, "x up"},
                                                          {0, -1, "x down"},
                                                          {1, +1, "y up"},
                                                          {1, -1, "y down"},
                                                          {2, +1, "z up"},
                                                          {2, -1, "z down"}}};

// The mean reading in one position and its uncertainty.
struct PositionReading {
  Vector3d f_B = Vector3d::Zero();         // true specific force as stated: +-g along one axis, m/s^2
  Vector3d mean_mps2 = Vector3d::Zero();   // reading by nominal sensitivities
  Matrix3d covariance = Matrix3d::Zero();  // of the mean, (m/s^2)^2
};

// Gathers one position's samples. The mean's covariance is told from means of batches, since what is
// correlated from sample to sample would make sigma / sqrt(n) too small.
class PositionRecorder {
 public:
  explicit PositionRecorder(std::int64_t samples_per_batch) : samples_per_batch_(samples_per_batch) {}
  void add(const Vector3d& reading);
  std::int64_t samples() const { return samples_; }
  Vector3d mean() const;             // of the whole batches
  Matrix3d mean_covariance() const;  // needs at least 2 batches; zero before

 private:
  std::int64_t samples_per_batch_;
  std::int64_t samples_ = 0, in_batch_ = 0, batches_ = 0;
  Vector3d batch_sum_ = Vector3d::Zero(), mean_ = Vector3d::Zero();
  Matrix3d sum_of_squares_ = Matrix3d::Zero();  // about the running mean (Welford 1962)
};

enum class SixPositionModel { kLinear, kBent };  // 12 unknowns, Lee 2014; or 15, with quadratic_pmps2

struct SixPositionFit {
  AccelerometerCalibration calibration;
  std::array<Vector3d, 6> residual_mps2;  // reading minus fit
  double residual_rms_mps2 = 0;
  double chi_square = 0;       // of the residuals; about the degrees of freedom where the
  int degrees_of_freedom = 6;  // stated uncertainties and the model are right
};

// fixture_sigma_rad: standard uncertainty of the fixture's angles about each axis. Positions in any order.
// Throws UserError where the positions do not determine all unknowns.
SixPositionFit fit_six_positions(const std::array<PositionReading, 6>& readings, double fixture_sigma_rad,
                                 SixPositionModel model = SixPositionModel::kLinear);

// A calibration held against the truth, where a simulation knows it: the error of each unknown that has an
// uncertainty (M row by row, b, q) over its standard uncertainty, 0 for the others, and all of them by their
// covariance.
struct CalibrationError {
  Eigen::Matrix<double, 15, 1> over_sigma = Eigen::Matrix<double, 15, 1>::Zero();
  double chi_square = 0;
  int degrees_of_freedom = 0;
};
CalibrationError error_against(const AccelerometerCalibration& found, const AccelerometerCalibration& truth);

}  // namespace waverig::estimator
