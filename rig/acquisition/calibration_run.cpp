#include "rig/acquisition/calibration_run.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lcmtypes/error.h"
#include "rig/mechanism/static_pose.h"

namespace waverig::rig {
namespace {

std::int64_t count_of(double duration_s, double step_s) { return std::llround(duration_s / step_s); }

}  // namespace

CalibrationRun run_six_positions(const UnitSettings& settings, const UnitParameters& unit,
                                 const Sensitivities& sensitivities, double gravity_mps2, std::uint64_t seed,
                                 const CalibrationRunSettings& run) {
  if (!(run.batch_s > settings.sample_interval_s && run.record_s >= 3 * run.batch_s))
    throw UserError(fmt::format("calibration: record_s = {}: expected at least three batches of {} s", run.record_s,
                                run.batch_s));
  SimulatedUnit sensor(settings, unit, seed);
  Acquisition acquisition(sensitivities);
  RandomStream fixture(seed, "calibration fixture");
  std::vector<std::uint8_t> bytes;

  CalibrationRun result;
  const std::int64_t step_us = std::llround(run.step_s / kMicrosecond);
  std::int64_t utime = run.begin_utime;
  Vector3d gyro_sum = Vector3d::Zero(), gyro_square = Vector3d::Zero();
  double temperature_sum = 0;
  for (std::size_t k = 0; k < kSixPositions.size(); ++k) {
    const StaticPose& pose = kSixPositions[k];
    const Vector3d miss(fixture.gaussian(run.fixture_sigma_rad), fixture.gaussian(run.fixture_sigma_rad),
                        fixture.gaussian(run.fixture_sigma_rad));
    BodyMotion motion = pose_motion(pose, miss, utime);
    if (k == 0) sensor.step(motion, 0, bytes);
    const std::int64_t settled_utime = utime + std::llround(run.settle_s / kMicrosecond);
    estimator::PositionRecorder recorder(count_of(run.batch_s, settings.sample_interval_s));
    Vector3d gyro = Vector3d::Zero();
    double temperature = 0;
    for (std::int64_t n = count_of(run.settle_s + run.record_s, run.step_s); n > 0; --n) {
      motion.utime = utime += step_us;
      sensor.step(motion, run.step_s, bytes);
      acquisition.add(bytes, [&](const UnitCounts& counts, const estimator::ImuSample& sample) {
        if (counts.utime < settled_utime) return;
        recorder.add(sample.f_B);
        gyro += sample.w_NB_B;
        temperature += sample.temperature_degC;
      });
      bytes.clear();
    }
    result.readings[k] = {pose.sign * gravity_mps2 * Vector3d::Unit(pose.axis), recorder.mean(), recorder.mean_covariance()};
    const double n = static_cast<double>(recorder.samples());
    gyro_sum += gyro / n;
    gyro_square += (gyro / n).cwiseAbs2();
    temperature_sum += temperature / n;
  }

  result.fit = estimator::fit_six_positions(result.readings, run.fixture_sigma_rad);
  result.end_utime = utime;
  estimator::SensorCalibration& c = result.calibration;
  c.sensor_id = run.sensor_id;
  c.method = "six positions";
  c.utime = utime;
  c.gravity_mps2 = gravity_mps2;
  c.temperature_degC = temperature_sum / 6;
  c.accelerometer = result.fit.calibration;
  // Scatter from position to position holds noise, instability and what gravity does to the gyroscope.
  c.gyroscope.offset_radps = gyro_sum / 6;
  c.gyroscope.offset_sigma_radps = ((gyro_square / 6 - c.gyroscope.offset_radps.cwiseAbs2()).cwiseMax(0) / 5).cwiseSqrt();
  c.residual_rms_mps2 = result.fit.residual_rms_mps2;
  c.chi_square = result.fit.chi_square;
  c.degrees_of_freedom = result.fit.degrees_of_freedom;
  return result;
}

estimator::AccelerometerCalibration true_calibration(const UnitSettings& settings, const UnitParameters& unit,
                                                     const Sensitivities& s, double temperature_degC) {
  const AccelerometerParameters& a = unit.accelerometer;
  const double warmer = temperature_degC - kReferenceTemperature_degC, g = settings.earth.g_N.norm();
  const Matrix3d M = (Vector3d::Ones() + warmer * a.scale_drift_pdegC).asDiagonal() * a.M;
  const Vector3d b = a.bias_mps2 + warmer * a.bias_drift_mps2pdegC;
  // The reading of one axis to its own linear input u: nonlinearity, stage, converter, nominal sensitivities.
  const auto reading = [&](int i, double u) {
    const auto k = static_cast<std::size_t>(i);
    const ConverterChannelSettings& c = unit.converter[k];
    const double bent = u * (1 + u * (a.quadratic_pmps2[i] + u * a.cubic_pmps4[i]));
    const double current = bent * settings.accelerometer.sensitivity_VpMps2 * unit.transconductance_ApV[i] - c.bias_A;
    const double quantum = (current > 0 ? c.negative_quantum_C * (1 + c.negative_scale_error)
                                        : c.positive_quantum_C * (1 + c.positive_scale_error)) /
                           (1 + c.reset_clock_error);
    const double nominal = current > 0 ? s.negative_quantum_C[i] : s.positive_quantum_C[i];
    const double told = current / quantum * nominal / (1 + settings.front_end.master_clock_error);
    return (told + s.converter_bias_A[i]) / s.current_per_accel_ApMps2;
  };
  estimator::AccelerometerCalibration truth;
  std::array<Vector3d, 6> readings;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3d u = M * (kSixPositions[k].sign * g * Vector3d::Unit(kSixPositions[k].axis)) + b;
    for (int i = 0; i < 3; ++i) readings[k][i] = reading(i, u[i]);
  }
  truth.b_mps2.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto up = static_cast<std::size_t>(2 * axis);
    truth.M.col(axis) = (readings[up] - readings[up + 1]) / (2 * g);
  }
  for (const Vector3d& r : readings) truth.b_mps2 += r / 6;
  return truth;
}

std::string calibration_report(const CalibrationRun& run, const estimator::AccelerometerCalibration& truth) {
  nlohmann::ordered_json j = nlohmann::ordered_json::parse(to_json(run.calibration));
  const estimator::AccelerometerCalibration& found = run.calibration.accelerometer;
  Eigen::Matrix<double, 12, 1> error;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      j["simulated_truth"]["M"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = truth.M(r, c);
      error[3 * r + c] = found.M(r, c) - truth.M(r, c);
    }
    j["simulated_truth"]["b_mps2"][static_cast<std::size_t>(r)] = truth.b_mps2[r];
    error[9 + r] = found.b_mps2[r] - truth.b_mps2[r];
  }
  for (int i = 0; i < 12; ++i)
    j["simulated_truth"]["error_over_sigma"][static_cast<std::size_t>(i)] = error[i] / std::sqrt(found.covariance(i, i));
  j["simulated_truth"]["chi_square_of_12"] = error.dot(found.covariance.ldlt().solve(error));
  for (std::size_t k = 0; k < 6; ++k) {
    auto& position = j["positions"][k];
    position["name"] = kSixPositions[k].name;
    for (int i = 0; i < 3; ++i) {
      const auto n = static_cast<std::size_t>(i);
      position["reading_g"][n] = run.readings[k].mean_mps2[i] / kStandardGravity;
      position["residual_mps2"][n] = run.fit.residual_mps2[k][i];
    }
  }
  return j.dump(2) + "\n";
}

}  // namespace waverig::rig
