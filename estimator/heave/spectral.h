// `spectral`: the sea state of a record from the variance density of its levelled acceleration.
//
// Overlapping Hann blocks give the density X of the acceleration at nodes an eighth of a second apart; the
// noise floor, found below the sea's lowest frequency, is taken off and the rest divided by w^4
// (node_spectrum.h). With the moments m_n = int f^n Z df:  Hm0 = 4 sqrt(m0), Tm01 = m0/m1, Tm02 =
// sqrt(m0/m2), Tm-10 = m_-1/m0; Tp by the centroid of Z^4 (Young 1995). Windows weigh the record's ends less
// than its middle, and a sea's variance wanders by several percent within a record: so the moments are scaled
// by what the smoothed heave and its rate have over the whole record against what they have under the
// windows' weight. Where a record is too short for several blocks that resolve its longest waves, the density
// is that of the smoothed heave in the longest block that fits. H1/3, H1/10, Hmax: zero-up-crossing waves of
// the smoothed heave.
#pragma once
#include "estimator/heave/record_smoother.h"
#include "estimator/method.h"

namespace waverig::estimator {

// Sea state of a smoothed record; hm0_sigma_m is the uncertainty against the record's own sea (noise,
// attitude, calibration), not that of the record as a sample of a longer sea. Flags: kTooFewWaves under
// twenty mean periods.
SeaState sea_state(const Record& record, const SmoothedRecord& smoothed, const SensorKnowledge& sensor);

class Spectral : public Method {
 public:
  explicit Spectral(const MethodSettings& settings) : settings_(settings) {}
  void add(const ImuSample& sample, Output&) override { record_.add(sample); }
  void finish(Output& output) override;  // heave, waves and the sea state

 private:
  MethodSettings settings_;
  Record record_;
};

}  // namespace waverig::estimator
