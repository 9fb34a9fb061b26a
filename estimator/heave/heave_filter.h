// HeaveFilter: Kalman filter of heave at the nodes, under a SeaModel. Causal; a step a node.
//
// State: the last `order` heaves z(k) … z(k-order+1), and drift (d, d', b, s_x, s_y): d'' = b + s . l, with l
// what a relative scale error s of the gyroscope leaks into the vertical (disturbance.h); in a steep sea that
// wanders with the groups of waves as no sea does. Measurement: the path, the acceleration's double integral,
// which is z(k) + d(k) exactly. Each step's drift is taken out of the path at once, so that path and speed
// are the estimate; the older heaves in the state are fixed-lag smoothed by every later measurement. What
// surprises is taken for sea, not for drift: in a steady sea only what no such sea does, in a restless one
// (that rises, or is made by hand) whatever is larger than usual.
//
// A rest in the middle of a sea (a rig between two runs, a board that is put down) is told by half a wave in
// which nothing about the body moves as the sea would move it: z then stands, and the path tells speed and
// bias alone. The sea that begins again is the same one, near the level of the rest.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

struct HeaveStep {  // one node interval
  LevelIncrement increment;
  // Two-sided density of the acceleration's noise where that is known to be more than the model's, which is
  // an average (attitude not settled, saturated samples; disturbance.h).
  double disturbance_m2ps3 = 0;
  double turn_mps2 = 0;  // change of the mean specific force, in the body's axes, from the interval before
};

class HeaveFilter {
 public:
  // offset_sigma_mps2: standard uncertainty of the mean vertical acceleration, the sensor's offset;
  // gyro_scale_sigma: relative.
  HeaveFilter(const SeaModel& model, double offset_sigma_mps2, double gyro_scale_sigma);
  // Keeps the drift; where the nodes lie otherwise from now on, the older heaves are forgotten.
  void set_model(const SeaModel& model);
  // The same, of a sea that just came up out of a calm, at the given level from its mean.
  void begin_sea(const SeaModel& model, double level_m);
  double count_from_here();  // shifts all heaves so that the newest is zero; returns what it was

  void step(const HeaveStep& step);
  // Node intervals without samples: the sea runs on by its model, path and speed are lost.
  void skip(int intervals);

  // At the last node plus `since_s`, given the increment from the node on.
  double heave_m(const LevelIncrement& partial, double since_s) const {
    return path_m_ + since_s * speed_mps_ + without_drift(partial, since_s).path_m;
  }
  double heave_rate_mps(const LevelIncrement& partial, double since_s) const {
    return speed_mps_ + without_drift(partial, since_s).speed_mps;
  }
  double variance_m2(const LevelIncrement& partial, double since_s) const;
  // Of the up axis over length_s, less bias and leaks.
  PathIncrement without_drift(const LevelIncrement& increment, double length_s) const {
    const PathIncrement sea = without_leaks(increment);
    return {sea.speed_mps - length_s * bias_mps2_, sea.path_m - length_s * length_s * bias_mps2_ / 2};
  }
  PathIncrement without_leaks(const LevelIncrement& increment) const {
    return {increment.speed_mps[0] - (gyro_scale_ * increment.speed_mps.tail<2>()).sum(),
            increment.path_m[0] - (gyro_scale_ * increment.path_m.tail<2>()).sum()};
  }

  // Heave at the node `lag` intervals ago, by all measurements since. lag < order.
  double lagged_heave_m(int lag) const { return z_[lag]; }
  double lagged_variance_m2(int lag) const { return P_(lag, lag); }
  double log_likelihood() const { return log_likelihood_; }  // of all steps, but for a constant
  bool surprised() const { return roughness_ > kTooRough; }  // the model has become too small for the motion
  double rest_s() const { return rests_ ? quiet_ * model_.interval_s : 0; }  // how long the body has rested
  bool stirs() const { return stirs_; }  // taken to rest, and moved, by far less than the sea would
  double recent_mps2() const { return std::sqrt(recent_m2ps4_); }  // rms acceleration of the last ten seconds
  double correction_m() const { return correction_m_; }            // of heave by the last step, if by a rest
  // By how many standard deviations the drift's speed has left what it was to be, from an earlier filter on.
  double drifted_from(const HeaveFilter& before, double elapsed_s) const;
  const SeaModel& model() const { return model_; }
  int order() const { return model_.order(); }

 private:
  static constexpr int kDrift = 5;
  using DriftVector = Eigen::Vector<double, kDrift>;
  using DriftMatrix = Eigen::Matrix<double, kDrift, kDrift>;
  static DriftMatrix transition(const LevelIncrement& increment, double dt_s);
  DriftMatrix drift() const { return P_.bottomRightCorner<kDrift, kDrift>().selfadjointView<Eigen::Lower>(); }
  void begin(const SeaModel& model, const DriftMatrix& drift);
  void begin_from_rest();
  void look_for_rest(const PathIncrement& sea, double turn_mps2);
  void predict(const LevelIncrement& increment, double noise_m2ps3);
  void update();

  SeaModel model_;
  Eigen::VectorXd z_;  // heaves, newest first
  double path_m_ = 0, speed_mps_ = 0, bias_mps2_ = 0;
  Eigen::Array2d gyro_scale_ = Eigen::Array2d::Zero();
  Eigen::MatrixXd P_;  // the lower triangle
  static constexpr double kTooRough = 5;
  static constexpr double kNoVariance = std::numeric_limits<double>::infinity();
  double log_likelihood_ = 0;
  double usual_variance_m2_ = kNoVariance;  // of the innovations, when nothing surprises
  double roughness_ = 1;                    // mean of the last innovations squared over that
  static constexpr double kNewSea = 2;
  double restlessness_ = kNewSea;  // mean of half a minute's, capped; restless until it is found steady
  double surprise_ = 1;  // how many times the model's innovation variance the sea is found to have just now
  PathIncrement last_;
  int quiet_ = 0;  // nodes without motion
  int onset_ = 0;  // nodes still to go after a rest, until roughness may tell of another sea
  bool rests_ = false, stirs_ = false;
  double drift_speed_mps_ = 0;  // taken out so far
  double correction_m_ = 0, recent_m2ps4_ = 0;
};

}  // namespace waverig::estimator
