// SeaGuess: the sea's spectrum from the first seconds, before any block of samples can resolve it.
//
// A wind sea of any age and size has a known shape (Pierson, Moskowitz 1964). For some peak periods between 2
// and 16 s, heights from a usual one down to a calm's, with the tail that the shape has and with tails that
// end at three to nine times the peak (a float, a tank), the likelihood of what is seen at the nodes is
// followed: each candidate predicts the next value from the last ones (Levinson), its size being the one that
// makes its own errors as large as they are. The guess is the candidates' mean, each weighed with its
// likelihood over its own variance: an error counts by how large it is beside the sea, so that a sea not yet
// told from a larger one is not taken for it.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

class SeaGuess {
 public:
  // dt_s: between nodes. bins: of the densities, at i / (2 (bins - 1) dt).
  SeaGuess(double dt_s, Eigen::Index bins, double accel_noise_m2ps3);
  void restart();
  // The next second difference of the path (node_spectrum.h). Their differences are what is predicted: a
  // constant acceleration, of the sensor's bias, tells nothing.
  void add(double second_difference_m);
  int seen() const { return seen_; }
  // Two-sided, m^2 s. Of nothing seen yet: each candidate alike, at a usual steepness.
  Eigen::VectorXd density_m2s() const;

 private:
  struct Candidate {
    Eigen::VectorXd density_m2s;
    Predictors predictors;
    std::vector<double> log_variance;  // of the predictors
    double prior = 1;                  // flat seas are less usual than steep ones
    double variance_m2 = 0;            // of the second differences
    double errors = 0;                 // sum of squared prediction errors over their variances
    double log_variances = 0;          // sum
  };
  std::vector<Candidate> candidates_;
  Eigen::VectorXd newest_;                           // differences of second differences, newest first
  double last_m_ = 0, mean_m_ = 0, squares_m2_ = 0;  // second differences: last, mean, squares about it
  int seen_ = 0;
};

}  // namespace waverig::estimator
