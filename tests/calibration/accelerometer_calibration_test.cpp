#include "estimator/calibration/accelerometer_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <filesystem>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

AccelerometerCalibration published_unit() {  // Lee 2014, section 2
  AccelerometerCalibration c;
  c.M << 1.0074, -0.0022, 0.0039, -0.0065, 0.9856, 0.0138, -0.0027, 0.0087, 0.9963;
  c.b_mps2 = Vector3d(-0.0354, 0.0081, 0.0041) * kStandardGravity;
  return c;
}

SensorCalibration full_calibration() {
  SensorCalibration c;
  c.sensor_id = "unit \"7\"";
  c.method = "six positions";
  c.utime = 1700000000000000;
  c.gravity_mps2 = 9.8062;
  c.temperature_degC = 23.5;
  c.accelerometer = published_unit();
  c.accelerometer.quadratic_pmps2 << 1e-4, -2e-4, 3e-4;
  const Matrix15d A = Matrix15d::Random();
  c.accelerometer.covariance = 1e-6 * A * A.transpose();
  c.gyroscope = {{0.01, -0.02, 0.03}, {1e-4, 2e-4, 3e-4}};
  c.residual_rms_mps2 = 1.0 / 3;
  c.chi_square = 5.5;
  c.degrees_of_freedom = 6;
  return c;
}

std::string complaint(const std::string& text) {
  try {
    calibration_from_json(text, "unit.json");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(AccelerometerCorrection, UndoesThePublishedErrorModel) {
  const AccelerometerCalibration c = published_unit();
  const AccelerometerCorrection correction(c);
  const Vector3d f(1.2, -3.4, -9.7);
  EXPECT_LT((correction(c.M * f + c.b_mps2) - f).norm(), 1e-14);
}

TEST(AccelerometerCorrection, StraightensABentCharacteristicExactly) {
  AccelerometerCalibration c = published_unit();
  c.quadratic_pmps2 << 2e-3 / kStandardGravity, -4e-3 / kStandardGravity, 0;
  const AccelerometerCorrection correction(c);
  for (const Vector3d& f : {Vector3d(1.2, -3.4, -9.7), Vector3d(-39, 39, 39), Vector3d(0, 0, 0)})
    EXPECT_LT((correction(c.reading(f)) - f).norm(), 1e-12);
}

TEST(AccelerometerCorrection, RefusesWhatIsNoSensor) {
  AccelerometerCalibration c;
  c.M.setZero();
  EXPECT_THROW(AccelerometerCorrection{c}, UserError);
  c = {};
  c.b_mps2.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(AccelerometerCorrection{c}, UserError);
  c = {};
  c.quadratic_pmps2.y() = 0.1;
  EXPECT_THROW(AccelerometerCorrection{c}, UserError);
}

TEST(AccelerometerCalibration, StatesTheUncertaintyOfACorrectedForceAsSimulationFindsIt) {
  AccelerometerCalibration c = published_unit();
  c.covariance.diagonal().setConstant(1e-8);
  c.covariance.diagonal().segment<3>(9).setConstant(4e-6);
  c.covariance.diagonal().tail<3>().setConstant(1e-10);
  const Vector3d f(0.5, -1, -9.6), stated = c.sigma_f_mps2(f);
  RandomStream random(1, "errors");
  Vector3d square = Vector3d::Zero();
  constexpr int kRuns = 20000;
  for (int run = 0; run < kRuns; ++run) {
    AccelerometerCalibration wrong = c;
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) wrong.M(r, k) += random.gaussian(1e-4);
      wrong.b_mps2[r] += random.gaussian(2e-3);
      wrong.quadratic_pmps2[r] += random.gaussian(1e-5);
    }
    square += (AccelerometerCorrection(wrong)(c.reading(f)) - f).cwiseAbs2();
  }
  const Vector3d found = (square / kRuns).cwiseSqrt();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i] / stated[i], 1, 0.03);
}

TEST(CalibrationFile, GivesBackEveryBitThatWasStored) {
  const SensorCalibration c = full_calibration();
  const auto path = std::filesystem::path(testing::TempDir()) / "waverig_calibration.json";
  store_calibration(c, path);
  const SensorCalibration back = load_calibration(path);
  std::filesystem::remove(path);
  EXPECT_EQ(back.sensor_id, c.sensor_id);
  EXPECT_EQ(back.utime, c.utime);
  EXPECT_EQ(back.gravity_mps2, c.gravity_mps2);
  EXPECT_EQ(back.temperature_degC, c.temperature_degC);
  EXPECT_EQ(back.accelerometer.M, c.accelerometer.M);
  EXPECT_EQ(back.accelerometer.b_mps2, c.accelerometer.b_mps2);
  EXPECT_EQ(back.accelerometer.quadratic_pmps2, c.accelerometer.quadratic_pmps2);
  EXPECT_EQ(back.accelerometer.covariance, c.accelerometer.covariance);
  EXPECT_EQ(back.gyroscope.offset_radps, c.gyroscope.offset_radps);
  EXPECT_EQ(back.gyroscope.offset_sigma_radps, c.gyroscope.offset_sigma_radps);
  EXPECT_EQ(back.residual_rms_mps2, c.residual_rms_mps2);
  EXPECT_EQ(to_json(back), to_json(c));
}

TEST(CalibrationFile, KeepsAnUnknownTemperatureUnknown) {
  SensorCalibration c = full_calibration();
  c.temperature_degC = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(calibration_from_json(to_json(c), "x").temperature_degC));
}

TEST(CalibrationFile, RefusesAVarianceBelowZero) {
  SensorCalibration c = full_calibration();
  c.accelerometer.covariance(1, 1) = -1e-6;
  EXPECT_NE(complaint(to_json(c)).find("/accelerometer/covariance = -1e-06: expected variances"), std::string::npos)
      << complaint(to_json(c));
}

TEST(CalibrationFile, RefusesWhatNoUnitIsLike) {
  const auto said = [](auto change) {
    SensorCalibration c = full_calibration();
    change(c);
    return complaint(to_json(c));
  };
  for (const double g_mps2 : {-3.0, 9.69, 9.92, 981.0})
    EXPECT_NE(said([&](auto& c) { c.gravity_mps2 = g_mps2; }).find("unit.json: /gravity_mps2 = "), std::string::npos);
  EXPECT_EQ(said([](auto& c) { c.gravity_mps2 = 9.764; }), "") << "Huascaran";
  EXPECT_EQ(said([](auto& c) { c.gravity_mps2 = 9.834; }), "") << "the Arctic Ocean";
  EXPECT_NE(said([](auto& c) { c.accelerometer.b_mps2.y() = -50; }).find("/accelerometer/b_mps2 = ["), std::string::npos);
  EXPECT_NE(said([](auto& c) { c.gyroscope.offset_radps.z() = 1e300; }).find("/gyroscope/offset_radps = ["),
            std::string::npos);
  EXPECT_NE(said([](auto& c) { c.degrees_of_freedom = -1; }).find("/degrees_of_freedom = -1"), std::string::npos);
  const std::string text = to_json(full_calibration());
  const std::size_t at = text.find("\"degrees_of_freedom\": ") + 22;
  EXPECT_NE(complaint(text.substr(0, at) + "1000000000000\n}\n").find("/degrees_of_freedom = 1000000000000"),
            std::string::npos);
}

TEST(CalibrationFile, RefusesAKeyThatIsThereTwice) {
  const std::string text = to_json(full_calibration());
  EXPECT_NE(complaint(with(text, "\"method\"", "\"method\": \"x\", \"method\"")).find("unit.json: 'method' is there twice"),
            std::string::npos);
  EXPECT_NE(complaint(with(text, "\"M\"", "\"M\": [], \"M\"")).find("'M' is there twice"), std::string::npos);
}

TEST(CalibrationFile, NamesFileAndKeyOfWhatIsWrong) {
  const std::string text = to_json(full_calibration());
  EXPECT_EQ(complaint(text), "");
  EXPECT_NE(complaint("{").find("unit.json: is no JSON"), std::string::npos);
  EXPECT_NE(complaint("[1]").find("/format is missing"), std::string::npos);
  EXPECT_NE(complaint(with(text, "\"gravity_mps2\"", "\"gravity\"")).find("/gravity_mps2 is missing"),
            std::string::npos);
  EXPECT_NE(complaint(with(text, "9.8062", "\"much\"")).find("/gravity_mps2 = \"much\": expected a number"),
            std::string::npos);
  EXPECT_NE(complaint(with(text, "1.0074", "7.0")).find("M: expected a matrix"), std::string::npos);
  EXPECT_NE(
      complaint(with(text, "1.0074,", "")).find("/accelerometer/M = [-0.0022,0.0039]: expected 3 lists of 3"),
      std::string::npos);
  EXPECT_THROW(load_calibration("/nonexistent/unit.json"), UserError);
}

}  // namespace
}  // namespace waverig::estimator
