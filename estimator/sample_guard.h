// SampleGuard: the one door through which samples enter a method. It lets good samples through in order of
// time and says of every sample what is wrong with it, in the QARTOD sense (lcmtypes/flags.h).
//
// clang-format off
//   not finite, or beyond what is plausible       kRange         not usable
//   repeated or out-of-order time                 kRange         not usable (there is a sample of that time)
//   samples missing before this one               kGap           usable; dt_s spans the gap
//   a minute or more missing before this one      kGap           not usable, the next one is; else a bad time stamp
//   specific force or rate of one sample far off
//     the way of its neighbours                   kSpike         not usable (three in a row are a step and pass)
//   the same reading for flat_line_s              kFlatLine      not usable until it changes
//   an axis at its limit                          kSaturation    usable for its time and rate; f_B is wrong
// clang-format on
// Flags that came with the sample stay on it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "estimator/types.h"

namespace waverig::estimator {

struct SampleGuardSettings {
  double accel_limit_mps2 = 0;  // output stage limit of an axis; 0: none
  double gyro_limit_radps = 0;
  double accel_plausible_mps2 = 500;  // beyond it: not a reading
  double gyro_plausible_radps = 100;
  double flat_line_s = 1.0;       // all three accelerometer axes without the least change; 0: off
  double spike_ratio = 15;        // times the usual change from sample to sample; 0: off
  double spike_floor_mps2 = 1.0;  // a smaller jump is never a spike
  double spike_floor_radps = 3;   // a board that is knocked makes 1
  double gap_ratio = 1.8;         // times the usual interval
};

// The longest gap over which a path or an attitude is carried on by what is seen on either side of it.
inline double longest_bridge_s(double usual_interval_s) { return 0.3 + 2 * usual_interval_s; }

struct GuardVerdict {
  bool usable = false;
  std::int32_t flags = 0;  // of the sample and of the guard
  double dt_s = 0;         // since the last usable sample; 0 for the first
  bool anew = false;       // the first, or after a gap too long to be bridged
};

class SampleGuard {
 public:
  explicit SampleGuard(const SampleGuardSettings& settings = {}) : settings_(settings) {}
  GuardVerdict check(const ImuSample& sample);
  double usual_interval_s() const { return interval_s_; }  // 0 until four samples came

 private:
  bool in_range(const ImuSample& sample) const;
  bool far_ahead(std::int64_t utime);
  bool flat(const ImuSample& sample);
  bool spike(const ImuSample& sample);
  void learn_interval(double dt_s, bool gap);

  SampleGuardSettings settings_;
  bool started_ = false;
  std::int64_t last_utime_ = 0;                           // of the last usable sample
  std::int64_t newest_utime_ = -(std::int64_t{1} << 62);  // usable or not
  std::optional<std::int64_t> ahead_utime_;               // far ahead of it, not believed yet
  Vector3d last_f_B_ = Vector3d::Zero(), last_w_NB_B_ = Vector3d::Zero();
  double interval_s_ = 0;
  std::array<double, 3> latest_s_{};  // intervals
  double usual_change_mps2_ = 0, usual_change_radps_ = 0;
  int changes_ = 0, jumps_ = 0, intervals_ = 0, gaps_ = 0;
  Vector3d flat_f_B_ = Vector3d::Constant(kUnknown);
  std::int64_t flat_since_ = 0;
};

}  // namespace waverig::estimator
