// SeaIdentifier: learns the SeaModel from the node increments while they come in.
//
// The second difference of the double-integrated acceleration at the nodes, x(k) = p(k+1) - 2 p(k) + p(k-1),
// needs no initial speed or position, and its density is exactly
//     X(f) = (2 - 2 cos w dt)^2 Z(f) + q dt^4 (2 + cos w dt) / 3
// with Z the density of heave sampled at the nodes (aliases and all) and q that of white acceleration noise.
// X is estimated by overlapping Hann periodograms with a fading memory; q where there is no sea, below the
// lowest frequency whose power stands out; Z is the rest.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

struct SeaIdentifierSettings {
  int order = 32;                   // of the autoregression: 16 s
  int block = 512;                  // nodes of a periodogram: 256 s
  int every = 32;                   // nodes from one periodogram to the next
  double memory_s = 900;            // of the density; 0: never forgets
  double accel_noise_m2ps3 = 6e-6;  // two-sided density assumed until it is seen; data sheet
};

class SeaIdentifier {
 public:
  explicit SeaIdentifier(const SeaIdentifierSettings& settings);
  ~SeaIdentifier();
  SeaIdentifier(const SeaIdentifier&) = delete;
  SeaIdentifier& operator=(const SeaIdentifier&) = delete;

  // One node interval. True when there is a new model.
  bool add(const PathIncrement& increment);
  void gap();  // the next increment does not follow on the last
  const SeaModel& model() const { return model_; }
  int periodograms() const { return periodograms_; }

 private:
  void periodogram();
  void identify();

  struct Transform;
  SeaIdentifierSettings settings_;
  std::unique_ptr<Transform> transform_;
  std::vector<double> ring_;  // second differences, newest at next_ - 1
  std::size_t next_ = 0, filled_ = 0;
  int until_next_ = 0, periodograms_ = 0;
  PathIncrement last_;
  bool has_last_ = false;
  Eigen::VectorXd density_;  // X, two-sided, m^2 s
  double weight_ = 0;
  SeaModel model_;
};

}  // namespace waverig::estimator
