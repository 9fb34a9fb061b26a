#include "estimator/compass/compass_calibration.h"

#include <Eigen/LU>
#include <cmath>

namespace waverig::estimator {
namespace {

// The norm cannot tell the field's strength from a common sensitivity: the data sheet's holds on the mean of
// the axes.
double field_of(const MagneticCalibration& calibration) {
  return 1 / std::cbrt(std::abs(calibration.gain.determinant()));
}

double mean_dip_rad(const MagneticCalibration& calibration, std::span<const Vector3d> raw,
                    std::span<const Vector3d> f_B) {
  double sum = 0;
  for (std::size_t i = 0; i < raw.size(); ++i)
    sum -= calibration.apply(raw[i]).normalized().dot(f_B[i].normalized());
  return std::asin(std::clamp(sum / static_cast<double>(raw.size()), -1.0, 1.0));
}

}  // namespace

CompassCalibration max_min_compass(std::span<const Vector3d> raw_uT, std::span<const Vector3d> f_B) {
  CompassCalibration result{
      .method = "max-min", .correction = max_min_calibration(raw_uT), .residual = {}, .left = {}};
  result.field_uT = field_of(result.correction);
  result.dip_rad = mean_dip_rad(result.correction, raw_uT, f_B);
  result.residual = norm_residual(raw_uT, result.correction);
  result.left.hard_iron_sigma = result.left.soft_iron_sigma = result.residual.relative_std;
  return result;
}

CompassCalibration ellipsoid_compass(std::span<const Vector3d> raw_uT, std::span<const Vector3d> f_B) {
  const EllipsoidFit fit = ellipsoid_calibration(raw_uT);
  const Alignment aligned = align_with_gravity(fit.calibration, raw_uT, f_B);
  CompassCalibration result{
      .method = "ellipsoid", .correction = aligned.calibration, .residual = {}, .left = {}};
  result.field_uT = field_of(fit.calibration);
  result.dip_rad = aligned.dip_rad;
  result.residual = fit.residual;
  result.left.hard_iron_sigma = std::sqrt(fit.covariance.diagonal().tail<3>().mean()) / result.field_uT;
  result.left.soft_iron_sigma = std::sqrt(fit.covariance.diagonal().head<6>().mean()) * result.field_uT;
  return result;
}

}  // namespace waverig::estimator
