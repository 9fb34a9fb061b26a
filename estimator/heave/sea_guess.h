// SeaGuess: the sea's spectrum from the first seconds, before any block of samples can resolve it.
//
// A wind sea of any age and size has a known shape (Pierson, Moskowitz 1964). For some peak periods between
// half a second and 16 s (below two: a tank, a board moved by hand), heights from a usual one down to a
// calm's, with the tail that the shape has and with tails that end at three to nine times the peak (a float),
// the likelihood of what is seen at the nodes is followed: each candidate predicts the next value from the
// last ones (Levinson), its size being the one that makes its own errors as large as they are, the sensor's
// offset as unknown as it is. The guess is the candidates' mean, each weighed with its likelihood over its
// own variance: an error counts by how large it is beside the sea, so that a sea not yet told from a larger
// one is not taken for it.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

class SeaGuess {
 public:
  // dt_s: between nodes. bins: of the densities, at i / (2 (bins - 1) dt).
  // offset_sigma_mps2: standard uncertainty of the mean vertical acceleration, the sensor's offset.
  SeaGuess(double dt_s, Eigen::Index bins, double accel_noise_m2ps3, double offset_sigma_mps2);
  void restart();                        // nothing was seen
  void gap();                            // the next value does not follow on the last
  void add(double second_difference_m);  // the next of the path (node_spectrum.h)
  struct Guess {
    Eigen::VectorXd density_m2s;  // two-sided. Of nothing seen yet: by the priors alone
    double doubt;                 // mean variance of the seas that it may be, over the guess's; at least one
  };
  Guess guess() const;

 private:
  struct Candidate {
    Eigen::VectorXd shape;  // of the density, which is sum_m2s times it
    double sum_m2s = 0;
    double prior = 1;        // flat seas are less usual than steep ones, short ones than long
    double variance_m2 = 0;  // of the second differences
  };
  std::vector<Candidate> candidates_;
  Predictors<Eigen::Dynamic> predictors_;         // a row a candidate
  std::vector<Eigen::ArrayXd> log_variances_of_;  // of theirs, by order
  Eigen::ArrayXd errors_, log_variances_;  // of each candidate: sums; squared errors are over their variances
  Eigen::VectorXd newest_;                 // second differences, newest first
  double mean_m_ = 0, squares_m2_ = 0;     // of second differences; squares about the mean
  int seen_ = 0, in_a_row_ = 0;
};

}  // namespace waverig::estimator
