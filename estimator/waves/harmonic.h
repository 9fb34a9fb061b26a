// Method "harmonic": regular waves, one by one, near the Cramer-Rao bound of REFERENCE section 3.
//
//   1 guard      bad samples are told and left out                               SampleGuard
//   2 level      attitude and gyro bias by blocks, from the samples alone        BlockLeveller
//   3 find       dominant period, then zero-up-crossings                         wave_finder
//   4 time       one frequency shared by up to nine neighbours that agree        wave_timing
//   5 fit        harmonic, offset and drift to the vertical acceleration         wave_fit
//   6 budget     noise from the residual, the calibration through the geometry   height_budget
// H = 2 A / w^2 of the fitted acceleration amplitude A. First and last partial waves are left out. Waves
// found while the period changes carry kSettling, waves that hardly stand out of the noise kBelowNoise.
//
// heave_m is the fitted wave, its phase running from crossing to crossing; unknown (NaN), with kSettling,
// where there is no wave. Everything comes late: by three quarters of a block and six waves. After a silence
// of the longest period a new stretch begins, that shares no wave with the one before; so memory is bounded
// by that delay whatever comes, and a gap costs the same however long.
#pragma once
#include <deque>
#include <vector>

#include "estimator/method.h"
#include "estimator/sample_guard.h"
#include "estimator/waves/block_leveller.h"
#include "estimator/waves/heave_order.h"
#include "estimator/waves/regular_waves.h"
#include "estimator/waves/wave_series.h"

namespace waverig::estimator {

struct HarmonicSettings {
  SampleGuardSettings guard;
  BlockLevellerSettings leveller;
  RegularWaveSettings waves;
};

class Harmonic final : public Method {
 public:
  explicit Harmonic(const MethodSettings& settings, const HarmonicSettings& own = {});
  void add(const ImuSample& sample, Output& output) override;
  void finish(Output& output) override;

 private:
  void gather();
  void process(bool last, Output& output);
  void give_wave(const RegularWave& wave, Output& output);
  void give_heave(const std::vector<RegularWave>& waves, double until_s, Output& output);

  static constexpr double kNever_s = -1;

  MethodSettings settings_;
  HarmonicSettings own_;
  SampleGuard guard_;
  HeaveOrder order_;
  BlockLeveller leveller_;
  WaveSeries series_;
  std::deque<LevelledSample> levelled_;  // waiting for their heave
  std::size_t gathered_ = 0;             // of levelled_, already in the series
  bool under_way_ = false;               // a stretch
  std::int64_t first_utime_ = 0;
  double silent_s_ = 0;              // since a sample that may enter a fit
  double given_until_s_ = kNever_s;  // end of the last wave given
  std::int64_t waves_ = 0;
};

}  // namespace waverig::estimator
