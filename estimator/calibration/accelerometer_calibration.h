// The calibration of an accelerometer, of a gyroscope's zero and of a compass, with its uncertainty, and its
// file (JSON).
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "estimator/compass/compass_calibration.h"
#include "motion/kinematics/frames.h"

namespace waverig::estimator {

using Matrix15d = Eigen::Matrix<double, 15, 15>;

// f_m = u + q u^2 axis by axis, u = M f + b. With q = 0 this is Lee 2014, eq. (1); q is the even part of the
// characteristic's bend, which six positions see as the difference between the level readings and the mean of
// up and down. f_m is the reading by nominal sensitivities, m/s^2.
struct AccelerometerCalibration {
  Matrix3d M = Matrix3d::Identity();
  Vector3d b_mps2 = Vector3d::Zero();
  Vector3d quadratic_pmps2 = Vector3d::Zero();  // q, per m/s^2
  // Of (M row by row: M11 M12 M13 M21 … M33, then b1 b2 b3, then q1 q2 q3). Zero where no uncertainty is
  // known.
  Matrix15d covariance = Matrix15d::Zero();

  Vector3d reading(const Vector3d& f_B) const;  // f_m
  Matrix3d sigma_M() const;                     // standard uncertainties, k = 1
  Vector3d sigma_b_mps2() const;
  // Standard uncertainty of the corrected specific force per axis at a given one, from the covariance.
  Vector3d sigma_f_mps2(const Vector3d& f_B) const;
};

// Lee 2014, eq. (16): f = M^-1 (f_m - b), with the inverse taken once; before it, where there is a bend, the
// root u of f_m = u + q u^2 that goes to f_m with q going to zero.
class AccelerometerCorrection {
 public:
  AccelerometerCorrection() = default;
  // Throws UserError where M is not near enough to the identity, or the bend not small enough, to be a
  // sensor's.
  explicit AccelerometerCorrection(const AccelerometerCalibration& calibration);
  Vector3d operator()(const Vector3d& f_m) const {
    if (!bent_) return M_inverse_ * (f_m - b_mps2_);
    const Eigen::Array3d root = (1 + 4 * q_ * f_m.array()).max(0.25).sqrt();  // far outside any range: held
    return M_inverse_ * ((2 * f_m.array() / (1 + root)).matrix() - b_mps2_);
  }

 private:
  Matrix3d M_inverse_ = Matrix3d::Identity();
  Vector3d b_mps2_ = Vector3d::Zero();
  Eigen::Array3d q_ = Eigen::Array3d::Zero();
  bool bent_ = false;
};

struct GyroscopeCalibration {
  Vector3d offset_radps = Vector3d::Zero();
  Vector3d offset_sigma_radps = Vector3d::Zero();
};

// Everything a calibration file holds.
struct SensorCalibration {
  std::string sensor_id;
  std::string method;                      // "six positions", "rotation"
  std::int64_t utime = 0;                  // when it was made
  double gravity_mps2 = kStandardGravity;  // at the place where it was made
  double temperature_degC = std::numeric_limits<double>::quiet_NaN();
  AccelerometerCalibration accelerometer;
  GyroscopeCalibration gyroscope;
  std::optional<CompassCalibration> compass;  // none: the unit has no magnetometer, or it was not calibrated
  double residual_rms_mps2 = 0;  // of the fit
  double chi_square = 0;         // residuals over their stated uncertainty
  int degrees_of_freedom = 0;
};

std::string to_json(const SensorCalibration& calibration);
// Throws UserError, naming name and key, where the text is no calibration.
SensorCalibration calibration_from_json(const std::string& text, const std::string& name);
void store_calibration(const SensorCalibration& calibration, const std::filesystem::path& path);
SensorCalibration load_calibration(const std::filesystem::path& path);

}  // namespace waverig::estimator
