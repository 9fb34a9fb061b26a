#include "rig/sensors/gyroscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

constexpr double kUnquantisedCount_radps = 1e-6;

}  // namespace

GyroscopeSettings fxas21000(double range_degps) {
  if (range_degps != 200 && range_degps != 400 && range_degps != 800 && range_degps != 1600)
    throw UserError(fmt::format("gyroscope: range {} deg/s: expected 200, 400, 800 or 1600", range_degps));
  GyroscopeSettings s;
  s.lsb_radps = range_degps / 8000 * kDegree;
  s.largest_count = 8191;
  s.noise_density_radps = 0.025 * kDegree;
  s.offset_sigma_radps = 1.0 * kDegree;
  s.offset_limit_radps = 3.0 * kDegree;
  s.scale_sigma = 0.01;
  s.misalignment_sigma = 0.01;
  s.offset_drift_sigma_radpspdegC = 0.02 * kDegree;
  s.g_sensitivity_sigma_s_rad_m = 0.02 * kDegree / kStandardGravity;
  s.instability_sigma_radps = 0.005 * kDegree;
  s.instability_time_s = 200;
  return s;
}

double gyroscope_count_radps(const GyroscopeSettings& settings) {
  return settings.lsb_radps > 0 ? settings.lsb_radps : kUnquantisedCount_radps;
}

GyroscopeParameters draw_gyroscope(const GyroscopeSettings& s, std::uint64_t seed) {
  RandomStream random(seed, "gyroscope unit");
  const auto vector = [&](double sigma) {
    return Vector3d(random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma));
  };
  GyroscopeParameters unit;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col)
      unit.M(row, col) += random.gaussian(row == col ? s.scale_sigma : s.misalignment_sigma);
  unit.offset_radps = vector(s.offset_sigma_radps);
  if (s.offset_limit_radps > 0)
    unit.offset_radps = unit.offset_radps.cwiseMax(-s.offset_limit_radps).cwiseMin(s.offset_limit_radps);
  unit.offset_drift_radpspdegC = vector(s.offset_drift_sigma_radpspdegC);
  unit.g_sensitivity_s_rad_m = vector(s.g_sensitivity_sigma_s_rad_m);
  return unit;
}

Gyroscope::Gyroscope(const GyroscopeSettings& settings, const GyroscopeParameters& unit, double interval_s,
                     std::uint64_t noise_seed)
    : settings_(settings),
      unit_(unit),
      // A one-sided density nd up to half the sampling rate 1/T has the variance nd^2 / (2 T).
      noise_sigma_(settings.noise_density_radps / std::sqrt(2 * interval_s)),
      counts_per_radps_(1 / gyroscope_count_radps(settings)),
      noise_stream_(noise_seed, "gyroscope noise"),
      instability_stream_(noise_seed, "gyroscope instability"),
      instability_(settings.instability_sigma_radps, settings.instability_time_s, interval_s,
                   instability_stream_) {}

GyroscopeReading Gyroscope::sample(const Vector3d& w_B_radps, const Vector3d& f_B, double temperature_degC) {
  Vector3d rate = unit_.M * w_B_radps + unit_.offset_radps;                                 // 1
  rate += (temperature_degC - kReferenceTemperature_degC) * unit_.offset_drift_radpspdegC;  // 2
  rate += unit_.g_sensitivity_s_rad_m.cwiseProduct(f_B);                                    // 3
  rate += instability_.advance(instability_stream_);                                        // 4
  if (noise_sigma_ > 0)                                                                     // 5
    for (int i = 0; i < 3; ++i) rate[i] += noise_stream_.gaussian(noise_sigma_);
  GyroscopeReading reading;
  for (int i = 0; i < 3; ++i) {  // 6
    double count = std::nearbyint(rate[i] * counts_per_radps_);
    const double limit = settings_.largest_count > 0 ? settings_.largest_count : 2.0e9;
    if (std::abs(count) >= limit) {
      count = std::copysign(limit, count);
      reading.saturated = true;
    }
    reading.counts[i] = static_cast<std::int32_t>(count);
  }
  return reading;
}

}  // namespace waverig::rig
