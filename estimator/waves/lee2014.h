// Method "lee2014": Lee, Lee, Heo 2014, eqs (2)-(13), with the corrected levelling rotation. The published
// baseline.
//
//   attitude   LeeAttitude, eqs (2)-(9)
//   heave      Kalman filter of state (a, v, p), eq (10), acceleration measured
//   waves      from crest to crest, f_w from the zero velocity at both; P(t) = alpha cos(2 pi f_w t) + beta t
//   + gamma
//              by least squares, eq (11); H = 2 alpha
//
// heave_m is the trace of eq. (10) as it is, drift and all (the paper's figure 5); the corrected trace of eq.
// (13) is alpha cos - alpha over each wave. The paper says nothing of how a zero of the velocity is told
// while the velocity itself runs away: here a reference line (its offset and velocity) is taken off the
// trace, each fitted wave moves the line by its gamma and beta, and the mean acceleration so far (a bias)
// bends the line for the zero of the velocity alone, not for the fit. So a bias b stays in the height as b
// T^2 / pi^2, and what calibration leaves of it is the wave's calibration uncertainty; the paper states none.
// A lost line, no crest for the longest period, starts anew at the latest sample; so does the one after a gap
// in which a crest may lie, across which nothing is integrated.
#pragma once
#include <vector>

#include "estimator/attitude/lee_attitude.h"
#include "estimator/method.h"
#include "estimator/sample_guard.h"
#include "estimator/waves/heave_order.h"

namespace waverig::estimator {

struct Lee2014Settings {
  LeeAttitudeSettings attitude;
  double accel_noise_mps2_rthz = 350e-6 * kStandardGravity;  // one-sided density; data sheet
  double jerk_mps3_rthz = 1.0;                               // of the heave filter's random-walk acceleration
  double shortest_period_s = 1.0;
  double longest_period_s = 25.0;
  double mean_memory_s = 100;  // of the mean acceleration; long beside a wave
};

class Lee2014 final : public Method {
 public:
  explicit Lee2014(const MethodSettings& settings, const Lee2014Settings& own = {});
  void add(const ImuSample& sample, Output& output) override;
  void finish(Output& output) override;

 private:
  struct Point {
    double t_s, p_m;  // since the crest; referenced height
  };
  void begin_anew();
  void track(double up_mps2, double dt_s);
  void look_for_crest(const ImuSample& sample, double dt_s, std::int32_t flags, Output& output);
  void close_wave(double period_s, std::int32_t flags, Output& output);
  void restart_reference();

  Lee2014Settings settings_;
  double offset_sigma_mps2_ = 0, scale_sigma_ = 0;  // of the levelled vertical acceleration
  SampleGuard guard_;
  HeaveOrder order_;
  LeeAttitude attitude_;

  // Eq. (10): state and the covariances that the gain needs. Those of v and p alone grow without bound
  // (nothing measures them) and are not kept.
  double a_mps2_ = 0, v_mps_ = 0, p_m_ = 0;
  double P_aa_ = 0, P_va_ = 0, P_pa_ = 0;
  bool started_ = false;

  // The reference line under the trace.
  double reference_v_mps_ = 0, reference_p_m_ = 0;
  double mean_a_mps2_ = 0, mean_s_ = 0;  // and over how long
  double bend_mps_ = 0;    // what the mean acceleration adds to the line's velocity since the crest
  double last_v_mps_ = 0;  // referenced, of the sample before

  // The wave in the making.
  bool has_crest_ = false;
  std::int64_t crest_utime_ = 0;
  double since_crest_s_ = 0;
  double since_reference_s_ = 0;
  std::int32_t wave_flags_ = 0;
  std::int64_t waves_ = 0;
  std::vector<Point> points_;
};

}  // namespace waverig::estimator
