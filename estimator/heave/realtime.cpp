#include "estimator/heave/realtime.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kLongestGap_s = 0.3;  // shorter ones are bridged by the parabola
constexpr double kLongestSkip_s = 60;  // a sea is forgotten after that
constexpr double kMotionMemory_s = 120;
constexpr double kSettling_s = 60;
constexpr std::size_t kRepeated = 160;  // nodes: 40 s
constexpr int kOldEnough = 120;         // fine nodes of one sea before another one is believed: half a minute

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
      integrator_(kFineInterval_s),
      identifier_(identifier_settings(attitude_settings(settings.sensor))),
      filter_(identifier_.model()),
      counter_(settings.sensor) {
  const double longest = (filter_.order() - 2) * kFineInterval_s;
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
  // 1. Level.
  const AttitudeSample& attitude = attitude_.update(sample);
  const double a_up = -attitude.a_N.z();
  const double share =
      std::max(1.0 / static_cast<double>(++samples_), guard_.usual_interval_s() / kMotionMemory_s);
  motion_.follow(attitude, share);
  disturbance_.add(disturbance_m2ps3(attitude, verdict.flags, settings_.sensor.gravity_mps2) +
                   turned_offset_m2ps3(attitude, motion_, settings_.sensor));
  // 2. Integrate, and at the nodes tell drift from sea.
  std::int32_t flags = verdict.flags | pending_flags_;
  pending_flags_ = 0;
  if (!started_ || verdict.dt_s > kLongestGap_s + 2 * guard_.usual_interval_s()) {
    if (started_) flags |= flag::kGap;
    restart(sample, a_up, output);
  } else {
    integrator_.add(sample.utime, a_up,
                    [&](std::int64_t, const PathIncrement& increment) { node(increment); });
  }
  // 3. Answer, now or after the lag.
  if (!attitude.settled || static_cast<double>(settled_nodes_) * kFineInterval_s < kSettling_s)
    flags |= flag::kSettling;
  held_.push_back(hold(sample, attitude));
  held_.back().sample.flags = flags;
  release(sample.utime - std::llround(settings_.fixed_lag_s * 1e6), output);
}

void Realtime::finish(Output& output) {
  if (!held_.empty()) release(held_.back().sample.utime, output);
}

void Realtime::restart(const ImuSample& sample, double a_up_mps2, Output& output) {
  if (started_) {
    finish(output);  // no later node tells more of what is held
    const double missing_s = static_cast<double>(sample.utime - integrator_.last_utime()) * kMicrosecond;
    filter_.skip(static_cast<int>(std::ceil(std::min(missing_s, kLongestSkip_s) / kFineInterval_s)));
    settled_nodes_ = 0;
    identifier_.gap();
    first_.clear();
  }
  integrator_.start(sample.utime, a_up_mps2);
  whole_.clear();
  disturbance_ = {};
  started_ = true;
}

void Realtime::node(const PathIncrement& increment) {
  filter_.step(increment, disturbance_.mean());
  if (first_.size() < kRepeated) first_.push_back({increment, disturbance_.mean()});
  whole_.push_back(increment);
  if (std::ssize(whole_) > filter_.order()) whole_.pop_front();
  disturbance_ = {};
  ++nodes_;
  ++settled_nodes_;
  if (identifier_.add(increment)) take_model();
  if (filter_.surprised() && identifier_.age() > kOldEnough) identifier_.forget();
}

void Realtime::take_model() {
  if (nodes_ == std::ssize(first_)) {  // still at the beginning: as if the model had been known
    filter_ = HeaveFilter(identifier_.model());
    for (const FirstStep& step : first_) filter_.step(step.increment, step.disturbance_m2ps3);
  } else {
    filter_.set_model(identifier_.model());
  }
}

Realtime::Held Realtime::hold(const ImuSample& sample, const AttitudeSample& attitude) const {
  Held held;
  held.sample.utime = sample.utime;
  held.sample.seq = sample.seq;
  held.sample.q_NB = attitude.q_NB;
  held.partial = integrator_.partial();
  held.since_node_s = integrator_.since_node_s();
  held.tilt_sigma_rad = attitude.tilt_sigma_rad;
  held.node = nodes_;
  return held;
}

void Realtime::estimate(const Held& held, HeaveSample& out) const {
  const auto ago = static_cast<int>(nodes_ - held.node);  // nodes since the one before the sample
  const double t = held.since_node_s;
  double variance;
  if (ago == 0) {
    out.heave_m = filter_.heave_m(held.partial, t);
    out.heave_rate_mps = filter_.heave_rate_mps(held.partial, t);
    variance = filter_.variance_m2(t);
  } else {  // between two nodes that are known by now
    const PathIncrement& whole = whole_[whole_.size() - static_cast<std::size_t>(ago)];
    const double dt = kFineInterval_s, b = filter_.bias_mps2();
    const double from = filter_.lagged_heave_m(ago), to = filter_.lagged_heave_m(ago - 1);
    const double speed = (to - from - whole.path_m + b * dt * dt / 2) / dt;
    out.heave_m = from + t * speed + held.partial.path_m - b * t * t / 2;
    out.heave_rate_mps = speed + held.partial.speed_mps - b * t;
    variance = filter_.lagged_variance_m2(ago - 1);
  }
  out.heave_sigma_m =
      std::sqrt(variance + systematic_variance_m2(filter_.model(), motion_, settings_.sensor));
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
