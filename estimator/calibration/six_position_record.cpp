#include "estimator/calibration/six_position_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "estimator/calibration/sample_steps.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

// Mean and largest standard deviation of an axis.
struct Spread {
  Vector3d mean;
  double largest_std;
};

Spread spread_of(std::span<const ImuSample> samples, Vector3d ImuSample::*reading) {
  const double n = static_cast<double>(samples.size());
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  for (const ImuSample& sample : samples) mean += sample.*reading / n;
  for (const ImuSample& sample : samples) square += (sample.*reading - mean).cwiseAbs2() / n;
  return {mean, std::sqrt(square.maxCoeff())};
}

bool has_gap(std::span<const ImuSample> samples, double longest_step_s) {
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (!(static_cast<double>(samples[i].utime - samples[i - 1].utime) * kMicrosecond <= longest_step_s))
      return true;
  return false;
}

std::optional<std::size_t> position_of(const Vector3d& f_B, double largest_tilt_rad) {
  for (std::size_t k = 0; k < kSixPositions.size(); ++k)
    if (kSixPositions[k].sign * f_B[kSixPositions[k].axis] > f_B.norm() * std::cos(largest_tilt_rad))
      return k;
  return std::nullopt;
}

std::size_t samples_per_window(std::span<const ImuSample> samples, double window_s) {
  const double step_s = std::max(median_step_s(samples), kMicrosecond);
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(window_s / step_s)));
}

GyroscopeCalibration offset_of(const std::vector<Vector3d>& rates) {
  const double n = static_cast<double>(rates.size());
  GyroscopeCalibration offset;
  for (const Vector3d& rate : rates) offset.offset_radps += rate / n;
  Vector3d square = Vector3d::Zero();
  for (const Vector3d& rate : rates) square += (rate - offset.offset_radps).cwiseAbs2();
  offset.offset_sigma_radps = (square / (n * (n - 1))).cwiseSqrt();
  return offset;
}

}  // namespace

SixPositionRecord fit_six_position_record(std::span<const ImuSample> samples, double gravity_mps2,
                                          const SixPositionRecordSettings& settings) {
  const std::size_t size = samples_per_window(samples, settings.window_s);
  const double longest_s = longest_step_s(samples);
  std::vector<PositionRecorder> recorders(6, PositionRecorder(static_cast<std::int64_t>(size)));
  std::vector<Vector3d> rates;
  SixPositionRecord record;
  double temperature_sum = 0;
  // 1. The still windows, each to its position. After one that is not still the next begins a quarter later,
  // so that no stretch loses much of its beginning.
  for (std::size_t begin = 0; begin + size <= samples.size();) {
    const auto window = samples.subspan(begin, size);
    const Spread force = spread_of(window, &ImuSample::f_B), rate = spread_of(window, &ImuSample::w_NB_B);
    const auto position = position_of(force.mean, settings.largest_tilt_rad);
    const bool still = force.largest_std < settings.still_force_mps2 &&
                       rate.largest_std < settings.still_rate_radps && !has_gap(window, longest_s);
    if (!still || !position) {
      begin += std::max<std::size_t>(1, size / 4);
      continue;
    }
    for (const ImuSample& sample : window) recorders[*position].add(sample.f_B);
    record.still_s[*position] += settings.window_s;
    rates.push_back(rate.mean);
    temperature_sum += window.front().temperature_degC;
    begin += size;
  }
  // 2. Six readings.
  std::array<PositionReading, 6> readings;
  for (std::size_t k = 0; k < 6; ++k) {
    const StaticPose& pose = kSixPositions[k];
    if (record.still_s[k] < settings.shortest_s)
      throw UserError(
          fmt::format("six-position calibration: {} held still for {:.0f} s; expected each position for "
                      "at least {:g} s",
                      pose.name, record.still_s[k], settings.shortest_s));
    readings[k].f_B = pose.sign * gravity_mps2 * Vector3d::Unit(pose.axis);
    readings[k].mean_mps2 = recorders[k].mean();
    readings[k].covariance = recorders[k].mean_covariance();
  }
  // 3. The fit.
  record.fit = fit_six_positions(readings, settings.fixture_sigma_rad);
  record.gyroscope = offset_of(rates);
  record.temperature_degC = temperature_sum / static_cast<double>(rates.size());
  return record;
}

}  // namespace waverig::estimator
