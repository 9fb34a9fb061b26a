#include "motion/run_clock.h"

#include <cmath>
#include <numbers>

namespace waverig::motion {
namespace {

using std::numbers::pi;

// Speed (1 +- cos(pi tau / Te)) / 2 with its integral and derivatives; sign +1 slows, -1 resumes.
RunClock::Reading easing(double tau_s, double ease_s, double sign) {
  const double k = pi / ease_s, sine = std::sin(k * tau_s), cosine = std::cos(k * tau_s);
  return {.profile_s = 0.5 * (tau_s + sign * sine / k),
          .speed = 0.5 * (1 + sign * cosine),
          .speed_1ps = -0.5 * sign * k * sine,
          .speed_1ps2 = -0.5 * sign * k * k * cosine};
}

}  // namespace

RunClock::Reading RunClock::read(double t_s) {
  if ((state_ == State::kSlowing || state_ == State::kResuming) && t_s - begin_s_ >= ease_s_) {
    state_ = state_ == State::kSlowing ? State::kHeld : State::kRunning;
    begin_s_ += ease_s_;
    begin_profile_s_ += 0.5 * ease_s_;
  }
  const double tau_s = t_s - begin_s_;
  Reading reading{.profile_s = tau_s};
  if (state_ == State::kHeld) reading = {.profile_s = 0, .speed = 0};
  if (state_ == State::kSlowing) reading = easing(tau_s, ease_s_, 1);
  if (state_ == State::kResuming) reading = easing(tau_s, ease_s_, -1);
  reading.profile_s += begin_profile_s_;
  return reading;
}

void RunClock::hold(double t_s, double ease_s) {
  if (state_ != State::kRunning) return;
  begin_profile_s_ = read(t_s).profile_s;
  begin_s_ = t_s;
  ease_s_ = ease_s;
  state_ = State::kSlowing;
}

void RunClock::resume(double t_s, double ease_s) {
  if (state_ != State::kHeld) return;
  begin_s_ = t_s;
  ease_s_ = ease_s;
  state_ = State::kResuming;
}

ProfilePoint eased(const RotationProfile& profile, const RunClock::Reading& r) {
  ProfilePoint p = profile.at(r.profile_s);
  const double rate = p.rate_radps, accel = p.accel_radps2;
  p.rate_radps = rate * r.speed;
  p.accel_radps2 = accel * r.speed * r.speed + rate * r.speed_1ps;
  p.jerk_radps3 =
      p.jerk_radps3 * r.speed * r.speed * r.speed + 3 * accel * r.speed * r.speed_1ps + rate * r.speed_1ps2;
  return p;
}

std::optional<double> ease_s_within(const AxisLimits& limits, const RotationProfile& profile,
                                    double profile_s, bool resuming) {
  constexpr int kPoints = 48;
  constexpr double kMargin = 0.97;  // for what lies between the points; the rate never grows by easing
  const AxisLimits inner{limits.rate_radps, kMargin * limits.accel_radps2, kMargin * limits.jerk_radps3};
  for (double ease_s = 0.25; ease_s < 60; ease_s *= 1.25) {
    bool inside = true;
    for (int i = 0; i <= kPoints && inside; ++i) {
      RunClock::Reading reading = easing(ease_s * i / kPoints, ease_s, resuming ? -1 : 1);
      reading.profile_s += profile_s;
      const ProfilePoint p = eased(profile, reading);
      inside = !exceeds(inner, p.rate_radps, p.accel_radps2, p.jerk_radps3);
    }
    if (inside) return ease_s;
  }
  return std::nullopt;
}

}  // namespace waverig::motion
