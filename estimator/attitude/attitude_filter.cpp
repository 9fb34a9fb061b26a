#include "estimator/attitude/attitude_filter.h"

#include <cmath>

#include "estimator/sample_guard.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kSaturatedRate_radps = 0.5;  // how wrong a saturated gyro may be
constexpr double kSaturatedAccel_mps2 = 10.0;
constexpr double kUnseenTurn_radps3 = 1, kUnseenRate_radps = 0.3;
constexpr double kUnseenSpeed_mps4 = 3, kUnseenAccel_mps2 = 1;
constexpr double kStartPath_m = 1.0, kStartSpeed_mps = 1.0;
constexpr double kSettledTilt_rad = 0.25 * kDegree;

}  // namespace

double unseen_speed_mps(double dt_s) {
  return std::min(kUnseenSpeed_mps4 * dt_s * dt_s * dt_s, kUnseenAccel_mps2 * dt_s);
}

TiltChain::TiltChain(const AttitudeSettings& s) {
  P = TiltState(square(kStartPath_m), square(kStartSpeed_mps), square(s.start_tilt_sigma_rad),
                square(s.gyro_bias_sigma_radps))
          .asDiagonal();
}

Eigen::Matrix4cd TiltChain::transition(double t, std::complex<double> turn, double g) {
  Eigen::Matrix4cd F = Eigen::Matrix4cd::Identity();
  F(0, 1) = t;
  F(0, 2) = g * t * t / 2;
  F(0, 3) = g * t * t * t / 6;
  F(1, 2) = g * t;
  F(1, 3) = g * t * t / 2;
  F(2, 3) = t;
  F(3, 3) = turn;
  return F;
}

void TiltChain::predict(const AttitudeSettings& s, double dt_s, std::complex<double> turn) {
  const Eigen::Matrix4cd F = transition(dt_s, turn, s.gravity_mps2);
  P = F * P * F.adjoint();
  P(1, 1) += square(s.accel_noise_mps2_rthz) / 2 * dt_s;  // one-sided density to two-sided
  P(2, 2) += square(s.gyro_noise_radps_rthz) / 2 * dt_s;
  P(3, 3) += square(s.gyro_bias_walk_radps_rts) * dt_s;
}

TiltState TiltChain::update(const AttitudeSettings& s, double dt_s) {
  const TiltState gain = P.col(0) / (P(0, 0).real() + s.motion_m2s / dt_s);
  P -= gain * P.row(0).eval();
  P = (0.5 * (P + P.adjoint())).eval();
  return gain;
}

std::complex<double> heading_turn(const Quaterniond& from_q_NB, const Quaterniond& to_q_NB) {
  const Quaterniond turned_N = to_q_NB * from_q_NB.conjugate();
  return std::polar(1.0, 2 * std::atan2(turned_N.z(), turned_N.w()));
}

AttitudeFilter::AttitudeFilter(const AttitudeSettings& settings) : settings_(settings), chain_(settings) {}

AttitudeFilter::AttitudeFilter(const AttitudeSettings& settings, const Quaterniond& q_NB,
                               const Vector3d& gyro_bias_B)
    : settings_(settings), chain_(settings), knows_attitude_(true) {
  state_.q_NB = q_NB;
  state_.gyro_bias_B = gyro_bias_B;
}

// Turns N so that the specific force stands upright; REFERENCE sections 0 and 2: at rest f_N = (0, 0, -g).
void AttitudeFilter::level(const Vector3d& f_B) {
  const Vector3d f_N = state_.q_NB * f_B;
  const Euler tilt{std::atan2(-f_N.y(), -f_N.z()), std::atan2(f_N.x(), std::hypot(f_N.y(), f_N.z())), 0};
  if (f_N.norm() > 0.1 * settings_.gravity_mps2)
    state_.q_NB = (quaternion_of(tilt) * state_.q_NB).normalized();
}

void AttitudeFilter::restart(const ImuSample& sample) {
  if (!knows_attitude_) level(sample.f_B);
  const std::complex<double> bias_variance = chain_.P(3, 3);
  chain_ = TiltChain(settings_);
  if (started_) chain_.P(3, 3) = bias_variance;  // a gap does not unlearn the gyro's bias
  position_N_ = velocity_N_ = 0;
  since_correction_s_ = 0;
  corrected_q_NB_ = state_.q_NB;
  restarted_ = true;
  correction_.restart_utime = sample.utime;
  started_ = true;
  knows_attitude_ = false;
}

const AttitudeSample& AttitudeFilter::update(const ImuSample& sample) {
  const double dt = static_cast<double>(sample.utime - state_.utime) * kMicrosecond;
  corrected_ = false;
  const Vector3d w_B = sample.w_NB_B - state_.gyro_bias_B;
  const Vector3d g_N(0, 0, settings_.gravity_mps2);
  const bool gap = (sample.flags & flag::kGap) != 0;
  if (started_ && !gap) usual_interval_s_ = dt;
  if (!started_ || (gap && dt > longest_bridge_s(usual_interval_s_))) {
    restart(sample);
    state_.a_N = state_.q_NB * sample.f_B + g_N;
  } else {
    // Rates are means over the sample interval: their own mean spans from middle to middle.
    const Vector3d turn_B = 0.5 * dt * (w_B + previous_w_B_);
    state_.q_NB = state_.q_NB * quaternion_exp(turn_B);
    const Vector3d a_N = state_.q_NB * sample.f_B + g_N;
    const Vector3d both_N = 0.5 * (a_N + state_.a_N);
    const std::complex<double> mean_a_N(both_N.x(), both_N.y());
    position_N_ += dt * velocity_N_ + 0.5 * dt * dt * mean_a_N;
    velocity_N_ += dt * mean_a_N;
    state_.a_N = a_N;
    if (sample.flags & flag::kSaturation) {
      chain_.P(1, 1) += square(kSaturatedAccel_mps2 * dt);
      chain_.P(2, 2) += square(kSaturatedRate_radps * dt);
    }
    if (gap) {
      chain_.P(1, 1) += square(unseen_speed_mps(dt));
      chain_.P(2, 2) += square(std::min(kUnseenTurn_radps3 * dt * dt * dt, kUnseenRate_radps * dt));
    }
    since_correction_s_ += dt;
    if (since_correction_s_ >= settings_.update_interval_s - 1e-6) correct(sample.utime, since_correction_s_);
  }
  previous_w_B_ = sample.w_NB_B - state_.gyro_bias_B;
  state_.utime = sample.utime;
  const double calibration = settings_.accel_bias_sigma_mps2 / settings_.gravity_mps2;
  const double variance = chain_.P(2, 2).real();
  state_.tilt_sigma_rad = std::sqrt(variance + square(calibration));
  state_.settled = variance < square(kSettledTilt_rad);
  return state_;
}

void AttitudeFilter::correct(std::int64_t utime, double dt_s) {
  correction_.dt_s = dt_s;
  correction_.turn = heading_turn(corrected_q_NB_, state_.q_NB);
  chain_.predict(settings_, dt_s, correction_.turn);
  correction_.predicted_P = chain_.P;
  const TiltState gain = chain_.update(settings_, dt_s);
  correction_.updated_P = chain_.P;
  const TiltState change = -position_N_ * gain;
  position_N_ += change[0];
  velocity_N_ += change[1];
  state_.q_NB = (quaternion_exp(tilt_rotation_N(change)) * state_.q_NB).normalized();
  state_.gyro_bias_B += state_.q_NB.conjugate() * bias_change_N(change);
  corrected_q_NB_ = state_.q_NB;
  correction_.utime = utime;
  correction_.applied = change;
  correction_.restarted = restarted_;
  restarted_ = false;
  corrected_ = true;
  since_correction_s_ = 0;
}

}  // namespace waverig::estimator
