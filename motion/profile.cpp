#include "motion/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

void require(bool good, const char* key, double value, const char* expected) {
  if (!good) throw UserError(fmt::format("profile: {} = {} is not {}", key, value, expected));
}

// The modulation sin x - sin(2x)/2 begins and ends a cycle with zero value and slope, has mean zero and this
// peak.
const double kModulationPeak = 0.75 * std::numbers::sqrt3;

}  // namespace

RotationProfile::RotationProfile(const ProfileSettings& settings) : settings_(settings) {
  const auto& s = settings_;
  require(std::isfinite(s.period_s) && s.period_s > 0, "period_s", s.period_s,
          "a positive number of seconds");
  require(std::isfinite(s.steady_s) && s.steady_s > 0 && s.steady_s / s.period_s < 1e6, "steady_s",
          s.steady_s, "a positive number of seconds below a million periods");
  require(s.ramp_periods >= 1 && s.ramp_periods <= 1000, "ramp_periods", s.ramp_periods,
          "between 1 and 1000");
  require(std::isfinite(s.rest_before_s) && s.rest_before_s >= 0, "rest_before_s", s.rest_before_s,
          "zero or more");
  require(std::isfinite(s.rest_after_s) && s.rest_after_s >= 0, "rest_after_s", s.rest_after_s,
          "zero or more");
  require(s.direction == 1 || s.direction == -1, "direction", s.direction, "+1 or -1");
  require(s.modulation_cycles >= 0, "modulation_cycles", s.modulation_cycles, "zero or more");
  require(s.rate_modulation >= 0 && s.rate_modulation <= 0.5, "rate_modulation", s.rate_modulation,
          "between 0 and 0.5");
  require(s.rate_drift >= -0.4 && s.rate_drift <= 0.4, "rate_drift", s.rate_drift, "between -0.4 and 0.4");

  rate_radps_ = s.direction * 2 * pi / s.period_s;
  end_rate_radps_ = rate_radps_ * (1 + s.rate_drift);
  steady_periods_ = static_cast<int>(std::ceil(s.steady_s / s.period_s - 1e-9));
  ramp_s_ = s.ramp_periods * s.period_s;
  steady_s_ = steady_periods_ * s.period_s;
  steady_begin_rad_ = ramp(ramp_s_, rate_radps_).angle_rad;
  steady_end_rad_ = steady_begin_rad_ + steady(steady_s_).angle_rad;
  end_rad_ = steady_end_rad_ + ramp(ramp_s_, end_rate_radps_).angle_rad;
}

// Raised cosine of the rate from zero: w(tau) = w (1 - cos(pi tau / Tr)) / 2, and its integral and
// derivatives.
ProfilePoint RotationProfile::ramp(double tau_s, double rate_radps) const {
  const double k = pi / ramp_s_;
  const double sine = std::sin(k * tau_s), cosine = std::cos(k * tau_s);
  return {.angle_rad = 0.5 * rate_radps * (tau_s - sine / k),
          .rate_radps = 0.5 * rate_radps * (1 - cosine),
          .accel_radps2 = 0.5 * rate_radps * k * sine,
          .jerk_radps3 = 0.5 * rate_radps * k * k * cosine};
}

ProfilePoint RotationProfile::steady(double tau_s) const {
  ProfilePoint p{.angle_rad = rate_radps_ * tau_s, .rate_radps = rate_radps_, .phase = Phase::kSteady};
  if (settings_.rate_drift != 0) {
    const double k = pi / steady_s_, drift = 0.5 * rate_radps_ * settings_.rate_drift;
    const double sine = std::sin(k * tau_s), cosine = std::cos(k * tau_s);
    p.angle_rad += drift * (tau_s - sine / k);
    p.rate_radps += drift * (1 - cosine);
    p.accel_radps2 += drift * k * sine;
    p.jerk_radps3 += drift * k * k * cosine;
  }
  if (settings_.rate_modulation != 0 && settings_.modulation_cycles != 0) {
    const double k = 2 * pi * settings_.modulation_cycles / steady_s_, x = k * tau_s;
    const double depth = rate_radps_ * settings_.rate_modulation / kModulationPeak;
    p.angle_rad += depth / k * (0.75 - std::cos(x) + 0.25 * std::cos(2 * x));
    p.rate_radps += depth * (std::sin(x) - 0.5 * std::sin(2 * x));
    p.accel_radps2 += depth * k * (std::cos(x) - std::cos(2 * x));
    p.jerk_radps3 += depth * k * k * (2 * std::sin(2 * x) - std::sin(x));
  }
  return p;
}

ProfilePoint RotationProfile::at(double t_s) const {
  if (t_s < ramp_begin_s()) return {.phase = Phase::kRest};
  if (t_s < steady_begin_s()) {
    ProfilePoint p = ramp(t_s - ramp_begin_s(), rate_radps_);
    p.phase = Phase::kRampIn;
    return p;
  }
  if (t_s < steady_end_s()) {
    ProfilePoint p = steady(t_s - steady_begin_s());
    p.angle_rad += steady_begin_rad_;
    return p;
  }
  if (t_s < ramp_end_s()) {  // the ramp in, mirrored in time
    const ProfilePoint mirrored = ramp(ramp_end_s() - t_s, end_rate_radps_);
    return {.angle_rad = end_rad_ - mirrored.angle_rad,
            .rate_radps = mirrored.rate_radps,
            .accel_radps2 = -mirrored.accel_radps2,
            .jerk_radps3 = mirrored.jerk_radps3,
            .phase = Phase::kRampOut};
  }
  return {.angle_rad = end_rad_, .phase = Phase::kStopped};
}

ProfilePeaks RotationProfile::peaks() const {
  const double rate = std::abs(rate_radps_), ramp_rate = std::max(rate, std::abs(end_rate_radps_));
  const double k = pi / ramp_s_;
  ProfilePeaks peaks{
      .rate_radps = ramp_rate, .accel_radps2 = 0.5 * ramp_rate * k, .jerk_radps3 = 0.5 * ramp_rate * k * k};
  if (settings_.modulation_cycles == 0 && settings_.rate_drift == 0) return peaks;

  const double drift = 0.5 * rate * std::abs(settings_.rate_drift), k_drift = pi / steady_s_;
  const double k_mod = 2 * pi * settings_.modulation_cycles / steady_s_;
  const double depth = settings_.modulation_cycles == 0 ? 0 : rate * settings_.rate_modulation;
  peaks.rate_radps += depth;
  peaks.accel_radps2 = std::max(peaks.accel_radps2, drift * k_drift + 2 * depth / kModulationPeak * k_mod);
  peaks.jerk_radps3 =
      std::max(peaks.jerk_radps3, drift * k_drift * k_drift + 3 * depth / kModulationPeak * k_mod * k_mod);
  return peaks;
}

}  // namespace waverig::motion
