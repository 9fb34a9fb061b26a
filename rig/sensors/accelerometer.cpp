#include "rig/sensors/accelerometer.h"

#include <algorithm>
#include <cmath>

namespace waverig::rig {

AccelerometerSettings mma7331lc() {
  constexpr double g = kStandardGravity;
  AccelerometerSettings s;
  s.sensitivity_VpMps2 = 0.308 / g;
  s.range_mps2 = 4 * g;
  s.noise_density_mps2 = 350e-6 * g;
  s.bias_sigma_mps2 = 0.03 * g;
  s.scale_sigma = 0.01;
  s.misalignment_sigma = 0.007;
  s.nonlinearity_sigma = 0.001;
  s.nonlinearity_limit = 0.01;
  s.bias_drift_sigma_mps2pdegC = 0.5e-3 * g;
  s.scale_drift_sigma_pdegC = 0.02e-2;
  s.instability_sigma_mps2 = 0.1e-3 * g;
  s.instability_time_s = 100;
  s.bandwidth_Hz = {400, 400, 300};
  return s;
}

AccelerometerParameters draw_accelerometer(const AccelerometerSettings& s, std::uint64_t seed) {
  RandomStream random(seed, "accelerometer unit");
  const auto vector = [&](double sigma) {
    return Vector3d(random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma));
  };
  AccelerometerParameters unit;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col)
      unit.M(row, col) += random.gaussian(row == col ? s.scale_sigma : s.misalignment_sigma);
  unit.bias_mps2 = vector(s.bias_sigma_mps2);
  const Vector3d even = vector(s.nonlinearity_sigma), odd = vector(s.nonlinearity_sigma);
  if (s.range_mps2 > 0) {
    // Over +-F the best straight line leaves +-q F^2 / 2 of q f^2 and +-c F^3 / 4 of c f^3; the span is 2 F.
    const double limit = s.nonlinearity_limit > 0 ? s.nonlinearity_limit : 1;
    const auto clipped = [&](double x) { return std::clamp(x, -limit, limit); };
    unit.quadratic_pmps2 = even.unaryExpr(clipped) * 4 / s.range_mps2;
    unit.cubic_pmps4 = odd.unaryExpr(clipped) * 8 / (s.range_mps2 * s.range_mps2);
  }
  unit.bias_drift_mps2pdegC = vector(s.bias_drift_sigma_mps2pdegC);
  unit.scale_drift_pdegC = vector(s.scale_drift_sigma_pdegC);
  return unit;
}

AccelerometerParameters lee2014_accelerometer() {
  AccelerometerParameters unit;
  unit.M << 1.0074, -0.0022, 0.0039, -0.0065, 0.9856, 0.0138, -0.0027, 0.0087, 0.9963;
  unit.bias_mps2 = Vector3d(-0.0354, 0.0081, 0.0041) * kStandardGravity;
  return unit;
}

Accelerometer::Accelerometer(const AccelerometerSettings& settings, const AccelerometerParameters& unit,
                             double interval_s, std::uint64_t noise_seed)
    : settings_(settings),
      unit_(unit),
      // White noise of one-sided density nd, averaged over T: variance nd^2 / (2 T), independent from mean to
      // mean.
      noise_sigma_(settings.noise_density_mps2 / std::sqrt(2 * interval_s)),
      noise_stream_(noise_seed, "accelerometer noise"),
      instability_stream_(noise_seed, "accelerometer instability"),
      instability_(settings.instability_sigma_mps2, settings.instability_time_s, interval_s,
                   instability_stream_),
      M_now_(unit.M),
      bias_now_(unit.bias_mps2) {
  for (int i = 0; i < 3; ++i)
    if (settings.bandwidth_Hz[i] > 0)
      time_constant_s_[i] = 1 / (2 * std::numbers::pi * settings.bandwidth_Hz[i]);
}

void Accelerometer::begin_interval(double temperature_degC) {
  const double warmer_degC = temperature_degC - kReferenceTemperature_degC;
  M_now_ = (Vector3d::Ones() + warmer_degC * unit_.scale_drift_pdegC).asDiagonal() * unit_.M;
  bias_now_ =
      unit_.bias_mps2 + warmer_degC * unit_.bias_drift_mps2pdegC + instability_.advance(instability_stream_);
  if (noise_sigma_ > 0)
    noise_ = {noise_stream_.gaussian(noise_sigma_), noise_stream_.gaussian(noise_sigma_),
              noise_stream_.gaussian(noise_sigma_)};
}

const Vector3d& Accelerometer::respond(const Vector3d& f_B, double dt_s) {
  const Vector3d linear = M_now_ * f_B + bias_now_;  // 1, 3, 4
  Vector3d input;
  for (int i = 0; i < 3; ++i) {  // 2
    const double u = linear[i];
    input[i] = u * (1 + u * (unit_.quadratic_pmps2[i] + u * unit_.cubic_pmps4[i]));
  }
  if (!started_) {
    input_ = filtered_ = input;
    started_ = true;
  }
  if (dt_s != decay_dt_s_) {
    decay_dt_s_ = dt_s;
    for (int i = 0; i < 3; ++i)
      decay_[i] = time_constant_s_[i] > 0 ? std::exp(-dt_s / time_constant_s_[i]) : 0;
  }
  for (int i = 0; i < 3; ++i) {  // 5, exact for a linear input
    const double lag = dt_s > 0 ? time_constant_s_[i] * (input[i] - input_[i]) / dt_s : 0;
    filtered_[i] = input[i] - lag + (filtered_[i] - input_[i] + lag) * decay_[i];
  }
  input_ = input;
  output_ = filtered_;
  if (settings_.range_mps2 > 0)  // 6
    output_ = output_.cwiseMax(-settings_.range_mps2).cwiseMin(settings_.range_mps2);
  return output_;
}

}  // namespace waverig::rig
