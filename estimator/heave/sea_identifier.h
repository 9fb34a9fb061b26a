// SeaIdentifier: learns the SeaModel from the node increments while they come in, by overlapping periodograms
// with a fading memory (node_spectrum.h).
#pragma once
#include <Eigen/Core>
#include <vector>

#include "estimator/heave/node_spectrum.h"
#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_guess.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

struct SeaIdentifierSettings {
  int order = 96;                       // of the autoregression
  double interval_s = kFineInterval_s;  // between the model's nodes; 0: as suits the sea
  int block = 640;                      // fine nodes of a periodogram: 160 s
  int every = 64;                       // fine nodes from one periodogram to the next; sooner at first
  double memory_s = 300;                // of the density; 0: never forgets
  double guess_weight = 0.01;           // of the guess beside periodograms, in whole blocks
  double accel_noise_m2ps3 = 6e-6;      // two-sided density assumed until it is seen; data sheet
  double offset_sigma_mps2 = 0.02;      // standard uncertainty of the mean vertical acceleration
};

class SeaIdentifier {
 public:
  explicit SeaIdentifier(const SeaIdentifierSettings& settings);

  // One fine node interval. True when so much is new that the sea is worth identifying again.
  bool add(const PathIncrement& increment);
  // By all that was added. swell: variance of a long swell under the guessed sea, relative to it; nothing
  // that is seen at a few nodes tells of it.
  const SeaModel& identify(double swell = 0);
  double doubt() const { return doubt_; }  // while the sea is guessed: how many times its variance it may have
  void restart();                 // nothing was added
  void gap();                     // the next increment does not follow on the last
  void forget(bool out_of_calm);  // the sea is another one from about now on; out of a calm it is guessed
  void keep(const SeaModel& model) { model_ = model; }  // what was identified is not believed
  // A calm under which a swell has come up of which nothing is known.
  SeaModel slow_sea() const;
  int age() const { return age_; }                   // nodes since the start, or since it forgot
  const SeaModel& model() const { return model_; }   // as last identified
  bool has_spectrum() const { return weight_ > 0; }  // not the guess alone
  bool calm() const;                                 // no sea to speak of, as last identified

 private:
  void periodogram();

  SeaIdentifierSettings settings_;
  Periodogram periodogram_;
  SeaGuess guess_;
  bool guesses_ = true;         // from the record's start, or out of a calm: of other seas nothing is guessed
  bool came_up_ = false;        // the sea is not the record's first
  Eigen::VectorXd unknown_;     // density of the unknown sea
  std::vector<double> newest_;  // second differences, oldest first
  int until_next_ = 0, age_ = 0;
  PathIncrement last_;
  bool has_last_ = false;
  Eigen::VectorXd density_;            // of the second differences, two-sided
  double weight_ = 0, lowest_hz_ = 0;  // of the periodograms, and what the last one resolves
  double doubt_ = 1;
  SeaModel model_;
};

}  // namespace waverig::estimator
