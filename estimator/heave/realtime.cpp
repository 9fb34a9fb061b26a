#include "estimator/heave/realtime.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kLongestGap_s = 0.3;  // shorter ones are bridged by the parabola
constexpr double kMotionMemory_s = 120;
constexpr std::int64_t kSettlingNodes = 120;  // a minute

double square(double x) { return x * x; }

SeaIdentifierSettings identifier_settings(const AttitudeSettings& attitude) {
  SeaIdentifierSettings s;
  s.accel_noise_m2ps3 = square(attitude.accel_noise_mps2_rthz) / 2;  // one-sided to two-sided
  return s;
}

}  // namespace

Realtime::Realtime(const MethodSettings& settings)
    : settings_(settings),
      attitude_(attitude_settings(settings.sensor)),
      integrator_(kNodeInterval_s),
      identifier_(identifier_settings(attitude_settings(settings.sensor))),
      filter_(identifier_.model()),
      counter_(settings.sensor) {
  const double longest = (identifier_.model().order() - 2) * kNodeInterval_s;
  if (!(settings.fixed_lag_s >= 0 && settings.fixed_lag_s <= longest))
    throw UserError("realtime: fixed_lag_s = " + std::to_string(settings.fixed_lag_s) + " is outside 0 to " +
                    std::to_string(longest) + " s");
}

void Realtime::add(const ImuSample& sample, Output& output) {
  const GuardVerdict verdict = guard_.check(sample);
  if (!verdict.usable) {
    pending_flags_ |= verdict.flags & ~flag::kGap;
    return;
  }
  const AttitudeSample& attitude = attitude_.update(sample);
  const double a_up = -attitude.a_N.z();
  const double share =
      std::max(1.0 / static_cast<double>(++samples_), guard_.usual_interval_s() / kMotionMemory_s);
  motion_.follow(attitude, sample.f_B, settings_.sensor.gravity_mps2, share);
  disturbance_.add(disturbance_m2ps3(attitude, verdict.flags, settings_.sensor.gravity_mps2) +
                   turned_offset_m2ps3(attitude, motion_, settings_.sensor));
  Held held;
  held.sample.flags = verdict.flags | pending_flags_;
  pending_flags_ = 0;
  if (!started_ || verdict.dt_s > kLongestGap_s + 2 * guard_.usual_interval_s()) {
    if (started_) held.sample.flags |= flag::kGap;
    restart(sample, a_up, output);
  } else {
    integrator_.add(sample.utime, a_up, [this](std::int64_t, const PathIncrement& whole) { node(whole); });
  }
  if (!attitude.settled || settled_nodes_ < kSettlingNodes) held.sample.flags |= flag::kSettling;
  held.sample.utime = sample.utime;
  held.sample.seq = sample.seq;
  held.sample.q_NB = attitude.q_NB;
  held.partial = integrator_.partial();
  held.since_node_s = integrator_.since_node_s();
  held.tilt_sigma_rad = attitude.tilt_sigma_rad;
  held.node = nodes_;
  held_.push_back(held);
  release(sample.utime - std::llround(settings_.fixed_lag_s * 1e6), output);
}

void Realtime::finish(Output& output) {
  if (!held_.empty()) release(held_.back().sample.utime, output);
}

void Realtime::restart(const ImuSample& sample, double a_up_mps2, Output& output) {
  if (started_) {
    finish(output);  // no later node tells more of what is held
    const double missing_s = static_cast<double>(sample.utime - integrator_.node_utime()) * kMicrosecond;
    const int intervals = static_cast<int>(std::clamp(std::round(missing_s / kNodeInterval_s), 1.0, 200.0));
    filter_.skip(intervals);
    nodes_ += intervals;
    settled_nodes_ = 0;
    identifier_.gap();
  }
  integrator_.start(sample.utime, a_up_mps2);
  disturbance_ = {};
  started_ = true;
}

void Realtime::node(const PathIncrement& increment) {
  filter_.step(increment, disturbance_.mean());
  disturbance_ = {};
  if (filter_.surprised() && identifier_.age() > kSettlingNodes / 2) identifier_.forget();
  if (identifier_.add(increment)) filter_.set_model(identifier_.model());
  ++nodes_;
  ++settled_nodes_;
  intervals_.push_back(increment);
  if (intervals_.size() > static_cast<std::size_t>(filter_.order())) intervals_.pop_front();
}

void Realtime::estimate(const Held& held, HeaveSample& out) const {
  const std::int64_t ago = nodes_ - held.node;  // nodes since the one before the sample
  double variance;
  if (ago <= 0) {
    out.heave_m = filter_.heave_m(held.partial, held.since_node_s);
    out.heave_rate_mps = filter_.heave_rate_mps(held.partial, held.since_node_s);
    variance = filter_.variance_m2(held.since_node_s);
  } else {  // between two nodes that are known by now
    const auto lag = static_cast<int>(ago);
    const PathIncrement& whole = intervals_[intervals_.size() - static_cast<std::size_t>(ago)];
    const double dt = kNodeInterval_s, t = held.since_node_s, b = filter_.bias_mps2();
    const double from = filter_.lagged_heave_m(lag), to = filter_.lagged_heave_m(lag - 1);
    const double speed = (to - from - whole.path_m + b * dt * dt / 2) / dt;
    out.heave_m = from + t * speed + held.partial.path_m - b * t * t / 2;
    out.heave_rate_mps = speed + held.partial.speed_mps - b * t;
    variance = filter_.lagged_variance_m2(lag - 1);
  }
  out.heave_sigma_m =
      std::sqrt(variance + systematic_variance_m2(identifier_.model(), motion_, settings_.sensor));
}

void Realtime::release(std::int64_t until_utime, Output& output) {
  while (!held_.empty() && held_.front().sample.utime <= until_utime) {
    HeaveSample out = held_.front().sample;
    estimate(held_.front(), out);
    output.heave(out);
    if (const auto wave = counter_.add(out, held_.front().tilt_sigma_rad)) output.wave(*wave);
    held_.pop_front();
  }
}

}  // namespace waverig::estimator
