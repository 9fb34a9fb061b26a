#include "estimator/calibration/accelerometer_calibration.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/calibration/readable_json.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using nlohmann::ordered_json;
constexpr double kLargestBend_pmps2 = 0.05 / kStandardGravity;
constexpr double kFarthestGravity_mps2 = 0.11;  // from the standard one, anywhere on Earth
constexpr double kLargestOffset_mps2 = kStandardGravity, kLargestOffset_radps = 10;
constexpr const char* kFormat = "waverig sensor calibration 1";

template <class Matrix>
ordered_json rows_of(const Matrix& m) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    rows.push_back(row);
  }
  return rows;
}

ordered_json list_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

class Reader {
 public:
  Reader(const ordered_json& document, std::string name) : document_(document), name_(std::move(name)) {}

  double number(const char* path) const { return number(at(path), path); }
  std::string text(const char* path) const {
    const ordered_json& node = at(path);
    if (!node.is_string()) refuse(path, node, "a text");
    return node.get<std::string>();
  }
  std::int64_t integer(const char* path) const {
    const ordered_json& node = at(path);
    if (!node.is_number_integer()) refuse(path, node, "a whole number");
    return node.get<std::int64_t>();
  }
  template <class Matrix>
  void matrix(const char* path, Matrix& m) const {
    const ordered_json& node = at(path);
    const auto fits = [](const ordered_json& n, Eigen::Index size) {
      return n.is_array() && n.size() == static_cast<std::size_t>(size);
    };
    const std::string expected = fmt::format("{} lists of {} numbers", m.rows(), m.cols());
    if (!fits(node, m.rows())) refuse(path, node, expected);
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
      const ordered_json& row = node[static_cast<std::size_t>(r)];
      if (!fits(row, m.cols())) refuse(path, row, expected);
      for (Eigen::Index c = 0; c < m.cols(); ++c) m(r, c) = number(row[static_cast<std::size_t>(c)], path);
    }
  }
  Vector3d vector(const char* path) const {
    const ordered_json& node = at(path);
    if (!node.is_array() || node.size() != 3) refuse(path, node, "a list of 3 numbers");
    return {number(node[0], path), number(node[1], path), number(node[2], path)};
  }
  [[noreturn]] void refuse(const char* path, const ordered_json& found, std::string_view expected) const {
    throw UserError(
        fmt::format("{}: {} = {}: expected {}", name_, path, found.dump().substr(0, 60), expected));
  }
  bool has(const char* path) const { return document_.contains(ordered_json::json_pointer(path)); }
  const ordered_json& at(const char* path) const {
    const ordered_json::json_pointer pointer(path);
    if (!document_.contains(pointer))
      throw UserError(fmt::format("{}: {} is missing: expected a calibration file", name_, path));
    return document_.at(pointer);
  }

 private:
  double number(const ordered_json& node, const char* path) const {
    if (!node.is_number()) refuse(path, node, "a number");
    return node.get<double>();
  }
  const ordered_json& document_;
  std::string name_;
};

ordered_json json_of(const CompassCalibration& c) {
  ordered_json j;
  j["method"] = c.method;
  j["gain_puT"] = rows_of(c.correction.gain);
  j["offset_uT"] = list_of(c.correction.offset);
  j["field_uT"] = c.field_uT;
  j["dip_rad"] = c.dip_rad;
  j["norm_relative_std"] = c.residual.relative_std;
  j["norm_relative_largest"] = c.residual.relative_largest;
  j["hard_iron_sigma"] = c.left.hard_iron_sigma;
  j["soft_iron_sigma"] = c.left.soft_iron_sigma;
  return j;
}

CompassCalibration compass_of(const Reader& in) {
  CompassCalibration c{.method = in.text("/compass/method"), .correction = {}, .residual = {}, .left = {}};
  in.matrix("/compass/gain_puT", c.correction.gain);
  c.correction.offset = in.vector("/compass/offset_uT");
  c.field_uT = in.number("/compass/field_uT");
  c.dip_rad = in.number("/compass/dip_rad");
  c.residual = {.mean = 1,
                .relative_std = in.number("/compass/norm_relative_std"),
                .relative_largest = in.number("/compass/norm_relative_largest")};
  c.left.hard_iron_sigma = in.number("/compass/hard_iron_sigma");
  c.left.soft_iron_sigma = in.number("/compass/soft_iron_sigma");
  const Matrix3d uneven = c.field_uT * c.correction.gain - Matrix3d::Identity();
  if (!(uneven.cwiseAbs().maxCoeff() < 0.5))
    in.refuse("/compass/gain_puT", in.at("/compass/gain_puT"),
              "field_uT times gain_puT within 0.5 of the identity");
  return c;
}

}  // namespace

Matrix3d AccelerometerCalibration::sigma_M() const {
  Matrix3d sigma;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) sigma(r, c) = std::sqrt(covariance(3 * r + c, 3 * r + c));
  return sigma;
}

Vector3d AccelerometerCalibration::sigma_b_mps2() const {
  return covariance.diagonal().segment<3>(9).cwiseSqrt();
}

Vector3d AccelerometerCalibration::reading(const Vector3d& f_B) const {
  const Vector3d u = M * f_B + b_mps2;
  return u + quadratic_pmps2.cwiseProduct(u.cwiseAbs2());
}

Vector3d AccelerometerCalibration::sigma_f_mps2(const Vector3d& f_B) const {
  // d f = -M^-1 (dM f + db + dq u^2), first order.
  const Vector3d u = M * f_B + b_mps2;
  Eigen::Matrix<double, 3, 15> J = Eigen::Matrix<double, 3, 15>::Zero();
  for (int r = 0; r < 3; ++r) {
    J.block<1, 3>(r, 3 * r) = f_B.transpose();
    J(r, 9 + r) = 1;
    J(r, 12 + r) = u[r] * u[r];
  }
  J = (M.inverse() * J).eval();
  return (J * covariance * J.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
}

AccelerometerCorrection::AccelerometerCorrection(const AccelerometerCalibration& calibration)
    : M_inverse_(calibration.M.inverse()),
      b_mps2_(calibration.b_mps2),
      q_(calibration.quadratic_pmps2.array()),
      bent_(!calibration.quadratic_pmps2.isZero(0)) {
  if (!calibration.M.allFinite() || !calibration.b_mps2.allFinite() ||
      !((calibration.M - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 0.5))
    throw UserError(
        "accelerometer calibration: M: expected a matrix within 0.5 of the identity, element by element");
  if (!(calibration.quadratic_pmps2.cwiseAbs().maxCoeff() < kLargestBend_pmps2))
    throw UserError("accelerometer calibration: quadratic_pmps2: expected a bend below 5 % of g at g");
}

std::string to_json(const SensorCalibration& c) {
  ordered_json j;
  j["format"] = kFormat;
  j["sensor_id"] = c.sensor_id;
  j["method"] = c.method;
  j["utime"] = c.utime;
  j["gravity_mps2"] = c.gravity_mps2;
  j["temperature_degC"] = c.temperature_degC;  // null where unknown
  j["accelerometer"]["M"] = rows_of(c.accelerometer.M);
  j["accelerometer"]["sigma_M"] = rows_of(c.accelerometer.sigma_M());
  j["accelerometer"]["b_mps2"] = list_of(c.accelerometer.b_mps2);
  j["accelerometer"]["sigma_b_mps2"] = list_of(c.accelerometer.sigma_b_mps2());
  j["accelerometer"]["quadratic_pmps2"] = list_of(c.accelerometer.quadratic_pmps2);
  j["accelerometer"]["covariance"] = rows_of(c.accelerometer.covariance);
  j["gyroscope"]["offset_radps"] = list_of(c.gyroscope.offset_radps);
  j["gyroscope"]["offset_sigma_radps"] = list_of(c.gyroscope.offset_sigma_radps);
  if (c.compass) j["compass"] = json_of(*c.compass);
  j["residual_rms_mps2"] = c.residual_rms_mps2;
  j["chi_square"] = c.chi_square;
  j["degrees_of_freedom"] = c.degrees_of_freedom;
  return readable_json(j);
}

SensorCalibration calibration_from_json(const std::string& text, const std::string& name) {
  const ordered_json document = ordered_json::parse(text, nullptr, false);
  if (document.is_discarded())
    throw UserError(fmt::format("{}: is no JSON: expected a calibration file", name));
  if (const std::string twice = key_given_twice(text); !twice.empty())
    throw UserError(fmt::format("{}: '{}' is there twice: expected it once", name, twice));
  const Reader in(document, name);
  if (in.text("/format") != kFormat) in.refuse("/format", in.at("/format"), fmt::format("\"{}\"", kFormat));
  SensorCalibration c;
  c.sensor_id = in.text("/sensor_id");
  c.method = in.text("/method");
  c.utime = in.integer("/utime");
  c.gravity_mps2 = in.number("/gravity_mps2");
  if (!(std::abs(c.gravity_mps2 - kStandardGravity) < kFarthestGravity_mps2))
    in.refuse("/gravity_mps2", c.gravity_mps2, "gravity somewhere on Earth, m/s^2");
  if (!in.at("/temperature_degC").is_null()) c.temperature_degC = in.number("/temperature_degC");
  in.matrix("/accelerometer/M", c.accelerometer.M);
  c.accelerometer.b_mps2 = in.vector("/accelerometer/b_mps2");
  if (!(c.accelerometer.b_mps2.cwiseAbs().maxCoeff() < kLargestOffset_mps2))
    in.refuse("/accelerometer/b_mps2", in.at("/accelerometer/b_mps2"), "offsets below g, m/s^2");
  c.accelerometer.quadratic_pmps2 = in.vector("/accelerometer/quadratic_pmps2");
  in.matrix("/accelerometer/covariance", c.accelerometer.covariance);
  if (!(c.accelerometer.covariance.diagonal().minCoeff() >= 0))
    in.refuse("/accelerometer/covariance", c.accelerometer.covariance.diagonal().minCoeff(),
              "variances of 0 or more on the diagonal");
  c.gyroscope.offset_radps = in.vector("/gyroscope/offset_radps");
  if (!(c.gyroscope.offset_radps.cwiseAbs().maxCoeff() < kLargestOffset_radps))
    in.refuse("/gyroscope/offset_radps", in.at("/gyroscope/offset_radps"), "offsets below 10 rad/s");
  c.gyroscope.offset_sigma_radps = in.vector("/gyroscope/offset_sigma_radps");
  if (in.has("/compass")) c.compass = compass_of(in);
  c.residual_rms_mps2 = in.number("/residual_rms_mps2");
  c.chi_square = in.number("/chi_square");
  const std::int64_t degrees = in.integer("/degrees_of_freedom");
  c.degrees_of_freedom = static_cast<int>(degrees);
  if (c.degrees_of_freedom != degrees || degrees < 0)
    in.refuse("/degrees_of_freedom", degrees, "a whole number from 0");
  AccelerometerCorrection usable(c.accelerometer);  // throws where it is none
  return c;
}

void store_calibration(const SensorCalibration& calibration, const std::filesystem::path& path) {
  write_atomically(path, to_json(calibration));
}

SensorCalibration load_calibration(const std::filesystem::path& path) {
  return calibration_from_json(content_of(path, "a calibration file"), path.string());
}

}  // namespace waverig::estimator
