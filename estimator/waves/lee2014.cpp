#include "estimator/waves/lee2014.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/flags.h"

namespace waverig::estimator {

Lee2014::Lee2014(const MethodSettings& settings, const Lee2014Settings& own)
    : settings_(own), attitude_([&] {
        LeeAttitudeSettings attitude = own.attitude;
        attitude.gravity_mps2 = settings.sensor.gravity_mps2;
        return attitude;
      }()) {
  const SensorKnowledge& known = settings.sensor;
  settings_.attitude.gravity_mps2 = known.gravity_mps2;
  offset_sigma_mps2_ = std::hypot(known.accel_bias_sigma_mps2, known.gravity_mps2 * known.accel_scale_sigma);
  scale_sigma_ = known.wave_scale_sigma();
}

void Lee2014::add(const ImuSample& sample, Output& output) {
  // 1. The door.
  const GuardVerdict verdict = guard_.check(sample);
  if (verdict.usable) {
    // A crest may lie in so long a gap, and a wave's way is not known across it.
    const bool anew = verdict.dt_s > std::max(settings_.shortest_period_s, 2 * guard_.usual_interval_s());
    if (anew) begin_anew();
    // 2. Attitude and levelling, eqs (2)-(9).
    const Quaterniond& q = attitude_.update(sample.f_B, sample.w_NB_B, verdict.dt_s);
    const Euler euler = euler_of(q);
    const double up_mps2 =
        -(levelled(sample.f_B, euler.roll_rad, euler.pitch_rad).z() + settings_.attitude.gravity_mps2);
    // 3. Heave, eq (10).
    const double dt_s = anew ? 0 : verdict.dt_s;
    track(up_mps2, dt_s);
    mean_s_ = std::min(mean_s_ + dt_s, settings_.mean_memory_s);
    if (dt_s > 0) mean_a_mps2_ += (up_mps2 - mean_a_mps2_) * std::min(dt_s / mean_s_, 1.0);
    // 4. Waves, eqs (11)-(13).
    look_for_crest(sample, dt_s, verdict.flags, output);
  }
  HeaveSample heave;
  heave.utime = sample.utime;
  heave.seq = sample.seq;
  heave.heave_m = p_m_;
  heave.heave_rate_mps = v_mps_;
  heave.q_NB = attitude_.q_NB();
  heave.flags = verdict.flags;
  order_.give(heave, verdict.usable, output);
}

void Lee2014::finish(Output&) {}  // the last wave, not closed by a crest, is left out

// After a gap: the trace goes on from where it was, as at the start of a record. What the mean acceleration
// has learnt stays.
void Lee2014::begin_anew() {
  started_ = false;
  P_aa_ = P_va_ = P_pa_ = 0;
  restart_reference();
}

void Lee2014::track(double up_mps2, double dt) {
  if (!started_) {
    started_ = true;
    a_mps2_ = up_mps2;
    return;
  }
  // Predict with the matrix of eq. (10).
  p_m_ += v_mps_ * dt + 0.5 * a_mps2_ * dt * dt;
  v_mps_ += a_mps2_ * dt;
  P_pa_ += P_va_ * dt + 0.5 * P_aa_ * dt * dt;
  P_va_ += P_aa_ * dt;
  P_aa_ += 0.5 * settings_.jerk_mps3_rthz * settings_.jerk_mps3_rthz * dt;
  // Correct with the measured acceleration; white noise of one-sided density d has variance d^2 / (2 dt) per
  // sample.
  const double R = 0.5 * settings_.accel_noise_mps2_rthz * settings_.accel_noise_mps2_rthz / dt;
  const double S = P_aa_ + R, residual = up_mps2 - a_mps2_;
  a_mps2_ += P_aa_ / S * residual;
  v_mps_ += P_va_ / S * residual;
  p_m_ += P_pa_ / S * residual;
  const double left = R / S;
  P_pa_ *= left;
  P_va_ *= left;
  P_aa_ *= left;
}

void Lee2014::restart_reference() {
  reference_p_m_ = p_m_;
  reference_v_mps_ = v_mps_;
  bend_mps_ = 0;
  last_v_mps_ = 0;
  since_reference_s_ = 0;
  has_crest_ = false;
  points_.clear();
}

void Lee2014::look_for_crest(const ImuSample& sample, double dt, std::int32_t flags, Output& output) {
  reference_p_m_ += reference_v_mps_ * dt;
  bend_mps_ += mean_a_mps2_ * dt;
  since_reference_s_ += dt;
  since_crest_s_ += dt;
  wave_flags_ |= flags;
  const double v = v_mps_ - reference_v_mps_ - bend_mps_;

  const bool crest =
      last_v_mps_ > 0 && v <= 0 && (!has_crest_ || since_crest_s_ >= settings_.shortest_period_s);
  if (crest) {
    // The zero lies between the two samples; both waves get the part that is theirs.
    const double after_s = dt * v / (v - last_v_mps_);
    if (has_crest_) close_wave(since_crest_s_ - after_s, wave_flags_, output);
    reference_v_mps_ += bend_mps_ - mean_a_mps2_ * after_s;
    bend_mps_ = mean_a_mps2_ * after_s;
    points_.clear();
    has_crest_ = true;
    since_crest_s_ = after_s;
    since_reference_s_ = after_s;
    crest_utime_ = sample.utime - std::llround(after_s / kMicrosecond);
    wave_flags_ = flags & ~flag::kGap;
  }
  if (has_crest_) points_.push_back({since_crest_s_, p_m_ - reference_p_m_});
  last_v_mps_ = v_mps_ - reference_v_mps_ - bend_mps_;
  if (since_reference_s_ > settings_.longest_period_s) restart_reference();
}

void Lee2014::close_wave(double period_s, std::int32_t flags, Output& output) {
  const double w = 2 * std::numbers::pi / period_s;
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  for (const Point& point : points_) {
    const Eigen::Vector3d row(std::cos(w * point.t_s), point.t_s, 1.0);  // eq. (11), delta = 0 at the crest
    N.noalias() += row * row.transpose();
    y += row * point.p_m;
  }
  if (points_.size() < 8) return;
  const Eigen::Vector3d fit = N.ldlt().solve(y);  // alpha, beta, gamma
  if (fit(0) > 0) {  // else it did not begin at a crest: noise at a near standstill
    Wave wave;
    wave.start_utime = crest_utime_;
    wave.seq = waves_++;
    wave.period_s = period_s;
    wave.height_m = 2 * fit(0);
    wave.calibration_sigma_m =
        std::hypot(offset_sigma_mps2_ * period_s * period_s / (std::numbers::pi * std::numbers::pi),
                   scale_sigma_ * wave.height_m);
    wave.flags = flags;
    output.wave(wave);
  }
  // The line under the next wave: what eq. (12) takes out of this one.
  reference_p_m_ += fit(2) + fit(1) * period_s;
  // The line's velocity is that of the middle of the wave; it goes on from the end.
  reference_v_mps_ += fit(1) - 0.5 * mean_a_mps2_ * period_s;
}

}  // namespace waverig::estimator
