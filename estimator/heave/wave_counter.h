// WaveCounter: single waves of a heave series, from zero-up-crossing to zero-up-crossing, while it comes in.
#pragma once
#include <optional>

#include "estimator/method.h"
#include "estimator/types.h"

namespace waverig::estimator {

class WaveCounter {
 public:
  explicit WaveCounter(const SensorKnowledge& sensor) : sensor_(sensor) {}

  // Heave about its zero line, in order of time. Answers with the wave this sample completes. A crossing
  // counts once the heave has been below minus a band and comes above plus it: noise makes no waves. The band
  // is twice heave's own sigma where nothing but that is seen, and in a sea the narrower the higher the sea,
  // whose small waves are to be counted too: heave's error is slower than waves. systematic_sigma_m: the part
  // of the sample's sigma that is common to all heave of the record. A wave carries the flags of its samples.
  std::optional<Wave> add(const HeaveSample& sample, double systematic_sigma_m, double tilt_sigma_rad);
  // Heave begins anew after a gap that was not bridged: the wave it falls into is left out.
  void gap() { below_ = has_last_ = has_start_ = false; }

 private:
  std::optional<Wave> cross(double tilt_sigma_rad);
  double band_m(const HeaveSample& sample);
  void reach(double heave_m, double sigma_m);

  SensorKnowledge sensor_;
  bool below_ = false, has_last_ = false, has_start_ = false;
  std::int64_t start_utime_ = 0, crossing_utime_ = 0, last_utime_ = 0, seq_ = 0;
  double mean_square_m2_ = 0;  // of heave, the last waves'
  double last_heave_m_ = 0, last_rate_mps_ = 0, crest_m_ = 0, trough_m_ = 0, crest_sigma_m_ = 0,
         trough_sigma_m_ = 0;
  std::int32_t flags_ = 0;
};

}  // namespace waverig::estimator
