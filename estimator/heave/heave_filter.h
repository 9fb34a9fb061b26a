// HeaveFilter: Kalman filter of heave at the nodes, under a SeaModel. Causal; a step a node.
//
// State: the last `order` heaves z(k) … z(k-order+1), and drift (d, d', b). Measurement: the path, the
// acceleration's double integral, which is z(k) + d(k) exactly. Each step's drift is taken out of the path at
// once, so that path and speed are the estimate; the older heaves in the state are fixed-lag smoothed by
// every later measurement. What surprises is taken for sea, not for drift: in a steady sea only what no such
// sea does, in a restless one (that rises, or is made by hand) whatever is larger than usual.
#pragma once
#include <Eigen/Core>
#include <limits>

#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

class HeaveFilter {
 public:
  // offset_sigma_mps2: standard uncertainty of the mean vertical acceleration, the sensor's offset.
  HeaveFilter(const SeaModel& model, double offset_sigma_mps2);
  // Keeps the drift; where the nodes lie otherwise from now on, the older heaves are forgotten.
  void set_model(const SeaModel& model);
  void begin_sea(const SeaModel& model);  // the same, of a sea that just came up

  // One node interval's increment. disturbance_m2ps3: two-sided density of the acceleration's noise where
  // that is known to be more than the model's, which is an average (attitude not settled, saturated samples;
  // disturbance.h).
  void step(const PathIncrement& increment, double disturbance_m2ps3);
  // Node intervals without samples: the sea runs on by its model, path and speed are lost.
  void skip(int intervals);

  // At the last node plus `since_s`, given the increment from the node on.
  double heave_m(const PathIncrement& partial, double since_s) const {
    return path_m_ + since_s * (speed_mps_ - since_s * bias_mps2_ / 2) + partial.path_m;
  }
  double heave_rate_mps(const PathIncrement& partial, double since_s) const {
    return speed_mps_ + partial.speed_mps - since_s * bias_mps2_;
  }
  double variance_m2(double since_s) const;

  // Heave at the node `lag` intervals ago, by all measurements since. lag < order.
  double lagged_heave_m(int lag) const { return z_[lag]; }
  double lagged_variance_m2(int lag) const { return P_(lag, lag); }
  double log_likelihood() const { return log_likelihood_; }  // of all steps, but for a constant
  bool surprised() const { return roughness_ > kTooRough; }  // the model has become too small for the motion
  const SeaModel& model() const { return model_; }
  int order() const { return model_.order(); }
  double bias_mps2() const { return bias_mps2_; }

 private:
  void begin(const SeaModel& model, const Eigen::Matrix3d& drift);
  void predict(double noise_m2ps3);
  void update();

  SeaModel model_;
  Eigen::VectorXd z_;  // heaves, newest first
  double path_m_ = 0, speed_mps_ = 0, bias_mps2_ = 0;
  Eigen::MatrixXd P_;  // the lower triangle
  static constexpr double kTooRough = 5;
  static constexpr double kNoVariance = std::numeric_limits<double>::infinity();
  double log_likelihood_ = 0;
  double usual_variance_m2_ = kNoVariance;  // of the innovations, when nothing surprises
  double roughness_ = 1;                    // mean of the last innovations squared over that
  static constexpr double kNewSea = 2;
  double restlessness_ = kNewSea;  // mean of half a minute's, capped; restless until it is found steady
  double surprise_ = 1;  // how many times the model's innovation variance the sea is found to have just now
};

}  // namespace waverig::estimator
