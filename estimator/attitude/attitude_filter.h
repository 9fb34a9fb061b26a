// AttitudeFilter: causal attitude of a body that sways about a place, from specific force and angular rate
// alone.
//
// Levelling by the bounded path. The levelled acceleration is integrated twice; a tilt error theta makes the
// path run away with g theta t^2 / 2, a wave does not. The pseudo-measurement "the horizontal path is about
// zero", white of density motion_m2s, drives per horizontal axis the chain of errors
//
//     dp' = dv,   dv' = g theta + n_a,   theta' = beta + n_g,   beta' = i psi' beta + n_b
//                                                    (beta: gyro bias error, rad/s; psi: heading)
//
// so wave accelerations reach the tilt only through the third power of (corner / wave frequency), while the
// gyro bias is learned within about half a minute. Both axes are one complex number, north + i east, with one
// Hermitian 4x4 covariance. The bias stays with the body: in N it turns with the heading, and a body that
// turns steadily, once in half a minute, would make a filter unstable that did not know it. Heading itself
// starts at zero and drifts: without a magnetometer N is a level frame that turns slowly.
#pragma once
#include <Eigen/Core>
#include <complex>
#include <cstdint>

#include "estimator/types.h"

namespace waverig::estimator {

struct AttitudeSettings {
  double gravity_mps2 = kStandardGravity;
  double gyro_noise_radps_rthz = 0.025 * kDegree;            // one-sided amplitude density; data sheet
  double gyro_bias_sigma_radps = 0.5 * kDegree;              // at the start
  double gyro_bias_walk_radps_rts = 2e-5;                    // rad/s per sqrt(s)
  double accel_noise_mps2_rthz = 350e-6 * kStandardGravity;  // one-sided amplitude density; data sheet
  double accel_bias_sigma_mps2 = 2e-3;                       // per axis, for the stated tilt uncertainty only
  double motion_m2s = 0.3;            // two-sided density of the horizontal path taken as white
  double start_tilt_sigma_rad = 0.1;  // of levelling by one sample of specific force
  double update_interval_s = 0.1;     // between two corrections
};

struct AttitudeSample {
  std::int64_t utime = 0;
  Quaterniond q_NB = Quaterniond::Identity();  // body to the level frame N
  Vector3d gyro_bias_B = Vector3d::Zero();     // rad/s; what the gyro reads too much
  Vector3d a_N = Vector3d::Zero();             // m/s^2, acceleration in N, gravity removed; down positive
  double tilt_sigma_rad = kUnknown;            // standard uncertainty of the tilt, per horizontal axis
  bool settled = false;                        // the tilt no longer remembers its start
};

// What a body may gain in speed, per axis, between two samples dt_s apart, unseen: the error of the trapezoid
// in a short sea, at most that sea's motion. Standard uncertainty.
double unseen_speed_mps(double dt_s);

// The chain's covariance and its step, shared by filter and smoother. State (p, v, theta, beta), each north +
// i east.
using TiltState = Eigen::Vector4cd;
struct TiltChain {
  Eigen::Matrix4cd P;  // Hermitian
  explicit TiltChain(const AttitudeSettings& settings);
  // turn: exp(i psi) of the heading's change psi over dt_s.
  static Eigen::Matrix4cd transition(double dt_s, std::complex<double> turn, double g);
  void predict(const AttitudeSettings& settings, double dt_s, std::complex<double> turn);
  TiltState update(const AttitudeSettings& settings,
                   double dt_s);  // returns the gain for the residual 0 - p
};
// Of the rotation between two attitudes of a body, its turn about the vertical.
std::complex<double> heading_turn(const Quaterniond& from_q_NB, const Quaterniond& to_q_NB);

// What one correction did: kept by the smoother.
struct AttitudeCorrection {
  std::int64_t utime = 0;
  TiltState applied = TiltState::Zero();
  double dt_s = 0;  // since the correction before
  std::complex<double> turn = 1;
  Eigen::Matrix4cd predicted_P, updated_P;
  bool restarted = false;          // levelled anew since the correction before: no memory across
  std::int64_t restart_utime = 0;  // when
};

class AttitudeFilter {
 public:
  explicit AttitudeFilter(const AttitudeSettings& settings);
  // Starts from a known attitude and bias instead of the first sample's specific force (second pass of the
  // smoother).
  AttitudeFilter(const AttitudeSettings& settings, const Quaterniond& q_NB, const Vector3d& gyro_bias_B);

  // Samples in increasing utime, repeats and stragglers already dropped; gaps are welcome. flag::kSaturation
  // and flag::kGap on a sample widen the uncertainty; after a gap that is too long to be bridged
  // (sample_guard.h) the attitude is levelled anew. Never throws.
  const AttitudeSample& update(const ImuSample& sample);

  // The correction made by the last update(), if it made one.
  const AttitudeCorrection* correction() const { return corrected_ ? &correction_ : nullptr; }

 private:
  void level(const Vector3d& f_B);
  void restart(const ImuSample& sample);
  void correct(std::int64_t utime, double dt_s);

  AttitudeSettings settings_;
  TiltChain chain_;
  AttitudeSample state_;
  AttitudeCorrection correction_;
  Quaterniond corrected_q_NB_ = Quaterniond::Identity();  // at the last correction or start
  Vector3d previous_w_B_ = Vector3d::Zero();
  std::complex<double> position_N_ = 0, velocity_N_ = 0;  // north + i east
  double since_correction_s_ = 0, usual_interval_s_ = 0;
  bool started_ = false, corrected_ = false, restarted_ = false, knows_attitude_ = false;
};

// The chain's tilt (rad) as a rotation vector in N: a_N errs by g theta along its own axis.
inline Vector3d tilt_rotation_N(const TiltState& change) {
  return {change[2].imag(), -change[2].real(), 0.0};
}
// The chain's bias error beta as an addition to gyro_bias_B, seen in N.
inline Vector3d bias_change_N(const TiltState& change) { return {-change[3].imag(), change[3].real(), 0.0}; }

}  // namespace waverig::estimator
