#include "rig/acquisition/calibration_run.h"

#include <fmt/format.h>

#include <cmath>

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
    throw UserError(fmt::format("calibration: record_s = {}: expected at least three batches of {} s",
                                run.record_s, run.batch_s));
  SimulatedUnit sensor(settings, unit, seed);
  Acquisition acquisition(sensitivities);
  if (run.front_end) acquisition.apply(*run.front_end);
  RandomStream fixture(seed, "calibration fixture");
  std::vector<std::uint8_t> bytes;

  CalibrationRun result;
  const std::int64_t step_us = std::llround(run.step_s / kMicrosecond);
  std::int64_t utime = run.begin_utime;
  Vector3d gyro_sum = Vector3d::Zero(), gyro_square = Vector3d::Zero();
  double temperature_sum = 0;
  std::array<double, 6> temperatures_degC{};
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
    result.readings[k] = {pose.sign * gravity_mps2 * Vector3d::Unit(pose.axis), recorder.mean(),
                          recorder.mean_covariance()};
    const double n = static_cast<double>(recorder.samples());
    gyro_sum += gyro / n;
    gyro_square += (gyro / n).cwiseAbs2();
    temperatures_degC[k] = temperature / n;
    temperature_sum += temperatures_degC[k];
  }

  // A position's own scatter knows nothing of what drifts from one position to the next: the data sheet does.
  const AccelerometerSettings& sheet = settings.accelerometer;
  const double drift_pdegC =
      std::hypot(sheet.bias_drift_sigma_mps2pdegC, sheet.scale_drift_sigma_pdegC * gravity_mps2);
  for (std::size_t k = 0; k < 6; ++k) {
    const double warmed = drift_pdegC * (temperatures_degC[k] - temperature_sum / 6);
    result.readings[k].covariance.diagonal().array() +=
        sheet.instability_sigma_mps2 * sheet.instability_sigma_mps2 + warmed * warmed;
  }

  result.fit = estimator::fit_six_positions(result.readings, run.fixture_sigma_rad, run.model);
  result.linear_fit = estimator::fit_six_positions(result.readings, run.fixture_sigma_rad);
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
  c.gyroscope.offset_sigma_radps =
      ((gyro_square / 6 - c.gyroscope.offset_radps.cwiseAbs2()).cwiseMax(0) / 5).cwiseSqrt();
  c.residual_rms_mps2 = result.fit.residual_rms_mps2;
  c.chi_square = result.fit.chi_square;
  c.degrees_of_freedom = result.fit.degrees_of_freedom;
  return result;
}

estimator::AccelerometerCalibration true_calibration(const UnitSettings& settings, const UnitParameters& unit,
                                                     const Sensitivities& s, double temperature_degC,
                                                     estimator::SixPositionModel model,
                                                     const std::optional<FrontEndChoice>& front_end) {
  const AccelerometerParameters& a = unit.accelerometer;
  const double warmer = temperature_degC - kReferenceTemperature_degC, g = settings.earth.g_N.norm();
  const Matrix3d M = (Vector3d::Ones() + warmer * a.scale_drift_pdegC).asDiagonal() * a.M;
  const Vector3d b = a.bias_mps2 + warmer * a.bias_drift_mps2pdegC;
  // The reading of one axis to its own linear input u: nonlinearity, stage, converter, nominal sensitivities.
  const auto reading = [&](int i, double u) {
    const auto k = static_cast<std::size_t>(i);
    const ConverterChannelSettings& c = unit.converter[k];
    const double bent = u * (1 + u * (a.quadratic_pmps2[i] + u * a.cubic_pmps4[i]));
    const double current =
        bent * settings.accelerometer.sensitivity_VpMps2 * unit.transconductance_ApV[i] - c.bias_A;
    const double quantum = (current > 0 ? c.negative_quantum_C * (1 + c.negative_scale_error)
                                        : c.positive_quantum_C * (1 + c.positive_scale_error)) /
                           (1 + c.reset_clock_error);
    double worth = current > 0 ? s.negative_quantum_C[i] : s.positive_quantum_C[i];
    double bias_A = s.converter_bias_A[i];
    if (front_end) {
      const estimator::FrontEndChannel& found = front_end->calibration.channel(front_end->channels[k]);
      worth = (current > 0 ? found.K_N_C(temperature_degC) : found.K_P_C(temperature_degC)) *
              (1 + front_end->calibration.oscillator.at(temperature_degC));
      bias_A = found.bias_A.at(temperature_degC);
    }
    const double told = current / quantum * worth / (1 + settings.front_end.master_clock_error);
    return (told + bias_A) / s.current_per_accel_ApMps2;
  };
  std::array<estimator::PositionReading, 6> readings;
  for (std::size_t k = 0; k < 6; ++k) {
    readings[k].f_B = kSixPositions[k].sign * g * Vector3d::Unit(kSixPositions[k].axis);
    const Vector3d u = M * readings[k].f_B + b;
    for (int i = 0; i < 3; ++i) readings[k].mean_mps2[i] = reading(i, u[i]);
  }
  return estimator::fit_six_positions(readings, 0, model).calibration;
}

double slope_sigma(const UnitSettings& settings, const estimator::AccelerometerCalibration& calibration) {
  const AccelerometerSettings& a = settings.accelerometer;
  const double g = settings.earth.g_N.norm(), k = a.range_mps2 > 0 ? g / a.range_mps2 : 0;
  // A bend of d spans: q = 4 d / F turns the slope at g by 2 q g, c = 8 d / F^2 by 3 c g^2, of which the
  // chord shows c g^2.
  const double cubic = 16 * k * k * a.nonlinearity_sigma;
  const Vector3d q_variance = calibration.covariance.diagonal().tail<3>();
  const double quadratic =
      q_variance.maxCoeff() > 0 ? 2 * g * std::sqrt(q_variance.mean()) : 8 * k * a.nonlinearity_sigma;
  // K_P and K_N differ by 2 e: the slope below zero is off the chord by e, and a quadratic fit turns it to
  // the other side.
  const double uneven = settings.front_end.scale_sigma / std::numbers::sqrt2;
  return std::hypot(cubic, quadratic, uneven);
}

}  // namespace waverig::rig
