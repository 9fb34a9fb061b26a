// Magnetometer calibration: hard iron (an offset) and soft iron with scale and misalignment (a matrix), from
// readings taken while the sensor is turned in a constant field. The document's max/min method and an
// ellipsoid fit, side by side. Raw readings in uT or in counts: the calibration turns either into a field of
// length 1.
#pragma once
#include <span>
#include <vector>

#include "estimator/compass/heading.h"

namespace waverig::estimator {

// m_B = gain (raw - offset); |m_B| = 1 in the field of the calibration.
struct MagneticCalibration {
  Matrix3d gain = Matrix3d::Identity();
  Vector3d offset = Vector3d::Zero();

  Vector3d apply(const Vector3d& raw) const { return gain * (raw - offset); }
};

// What a method knows of its compass: the calibration of ImuSample::m_B_uT (by default readings are taken as
// they are, calibrated on their way in) and the declination of the place, true = magnetic + declination.
struct CompassSettings {
  MagneticCalibration calibration{};
  double declination_rad = 0;
};

// How constant the calibrated norm is: its mean and standard deviation over the readings. 0 is perfect.
struct NormResidual {
  double mean = 0;
  double relative_std = 0;      // of the mean
  double relative_largest = 0;  // largest deviation from the mean
};
NormResidual norm_residual(std::span<const Vector3d> raw, const MagneticCalibration& calibration);

// Cho, eq. (8): each axis on its own, from its extremes; they must be visited (see RotationProcedure). No
// cross-axis soft iron. Throws UserError where an axis has no extent.
MagneticCalibration max_min_calibration(std::span<const Vector3d> raw);

struct EllipsoidFit {
  MagneticCalibration
      calibration;  // gain symmetric: a rotation of the whole triad cannot be seen in the norm
  NormResidual residual;
  Eigen::Matrix<double, 9, 9> covariance =
      Eigen::Matrix<double, 9, 9>::Zero();  // of the 6 of gain (xx, yy, zz, xy,
                                            // xz, yz), then offset
};

// Least squares of |gain (raw - offset)| = 1: algebraic ellipsoid first, then Gauss-Newton on the norm
// itself, since the algebraic fit is biased by noise. Outliers (a spike) are bounded by Huber weights. Needs
// at least 12 readings in general directions: throws UserError where they lie in a plane or on anything but
// an ellipsoid.
EllipsoidFit ellipsoid_calibration(std::span<const Vector3d> raw);

// The rotation that the norm cannot show, from the dip being the same in every attitude: turns the calibrated
// triad so that its component along gravity is constant. f_B: specific force at rest beside each reading, any
// unit.
struct Alignment {
  MagneticCalibration calibration;
  Vector3d rotation_B_rad = Vector3d::Zero();
  double dip_rad = 0;
  double dip_std_rad = 0;  // scatter over the readings that is left
};
Alignment align_with_gravity(const MagneticCalibration& calibration, std::span<const Vector3d> raw,
                             std::span<const Vector3d> f_B);

// The document's rotation procedure as a rig turns the sensor; attitudes against magnetic north in any known
// frame that has z down (the turntable's zero need not be north: the first turn finds it).
std::vector<Quaterniond> level_turn(int steps);  // about z, level
double north_from_level_turn(
    std::span<const Vector3d> raw);  // heading of the first reading; x longest at north
std::vector<Quaterniond> pitch_turn(double north_rad, int steps);  // x to north, about y: extremes of x and z
std::vector<Quaterniond> roll_turn(double north_rad, int steps);   // y to north, about x: extremes of y

}  // namespace waverig::estimator
