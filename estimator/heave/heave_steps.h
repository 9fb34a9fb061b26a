// HeaveSteps: levelled samples, integrated from node to node: what a HeaveFilter steps over.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/attitude/attitude_filter.h"
#include "estimator/heave/disturbance.h"
#include "estimator/heave/heave_filter.h"
#include "estimator/heave/path_integrator.h"
#include "estimator/method.h"

namespace waverig::estimator {

class HeaveSteps {
 public:
  explicit HeaveSteps(const SensorKnowledge& sensor);
  void forget_motion();                                                 // as if no sample had been seen
  void start(const ImuSample& sample, const AttitudeSample& attitude);  // with a node at the sample
  // Appends the node intervals that end with the sample. interval_s: between samples, as usual.
  void add(const ImuSample& sample, const AttitudeSample& attitude, double interval_s,
           std::vector<HeaveStep>& steps);
  // From the last node to the newest sample.
  const LevelIncrement& partial() const { return integrator_.partial(); }
  double since_node_s() const { return integrator_.since_node_s(); }
  std::int64_t last_utime() const { return integrator_.last_utime(); }
  const Motion& motion() const { return motion_; }

 private:
  struct MeanForce {  // specific force in the body's axes, over a node interval
    Vector3d sum_B = Vector3d::Zero(), before_B = Vector3d::Zero();
    int count = 0;
    void add(const Vector3d& f_B) {
      sum_B += f_B;
      ++count;
    }
    double change_mps2();  // from the interval before; the next one begins
  };

  SensorKnowledge sensor_;
  Integrator<Eigen::Array3d> integrator_;
  Motion motion_;
  std::int64_t samples_ = 0;     // of the motion
  MeanDisturbance disturbance_;  // since the last node
  MeanForce force_;
};

}  // namespace waverig::estimator
