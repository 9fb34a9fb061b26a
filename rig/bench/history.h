// History: every calibration is kept, a file each (the calibration file itself: instruments, files, version
// and uncertainties are in it), and any two can be held against each other.
#pragma once
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/calibration/front_end.h"

namespace waverig::rig::bench {

class History {
 public:
  explicit History(std::filesystem::path directory) : directory_(std::move(directory)) {}

  // Keeps it; returns the id under which it is kept: its own, or with a number where another of that id is
  // there already. The same calibration twice is kept once. Throws UserError where the directory cannot be
  // written.
  std::string keep(estimator::FrontEndCalibration calibration) const;

  // In the order of measurement. A file that is none is an error: nothing is passed over silently.
  std::vector<estimator::FrontEndCalibration> all() const;

  // By id, or from a calibration file outside the history. Throws UserError, naming the known ids.
  estimator::FrontEndCalibration find(const std::string& id_or_file) const;

 private:
  std::filesystem::path file_of(const std::string& id) const;

  std::filesystem::path directory_;
};

// What is told of a channel; each is a law over temperature with its uncertainty.
enum class Coefficient { kScaleN, kScaleP, kBias, kOscillator };
const char* name_of(Coefficient quantity);
const char* base_of(Coefficient quantity);  // "1" or "A"

struct Told {
  double value = 0, expanded = 0;  // at one temperature; k = 2
};
// Whether the calibration measured it, and where.
bool measured(const estimator::FrontEndCalibration& calibration, const estimator::FrontEndChannel& channel,
              Coefficient quantity);

// reference_common: the reference's own error (calibrator, function generator) is left out of the
// uncertainty: it is the same in all calibrations that are compared.
Told told(const estimator::FrontEndCalibration& calibration, const estimator::FrontEndChannel& channel,
          Coefficient quantity, double temperature_degC, bool reference_common);

struct Drift {
  std::string channel;  // empty: of the unit
  Coefficient quantity = Coefficient::kScaleN;
  double temperature_degC = 0;                            // where it is most significant
  double difference = 0;                                  // later less earlier
  double expanded = 0;                                    // of the difference, k = 2
  double score() const { return difference / expanded; }  // E_n of ISO 13528
  bool significant() const { return std::abs(score()) > 1; }
};

// Of all that both measured, at the temperatures both cover. Throws UserError where they are of two units or
// have nothing in common.
std::vector<Drift> compare(const estimator::FrontEndCalibration& earlier,
                           const estimator::FrontEndCalibration& later, bool reference_common);

}  // namespace waverig::rig::bench
