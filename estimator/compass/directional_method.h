// `directional`: where the waves of a record come from, by directional.h over the smoothed attitude. Gives a
// sea state with Hm0, direction, spread and check factor; nothing where the record carries no magnetic
// field.
#pragma once
#include "estimator/compass/directional.h"
#include "estimator/heave/record_smoother.h"
#include "estimator/method.h"

namespace waverig::estimator {

// The direction fields of a record's sea, for any method that has smoothed the attitude already (one
// AttitudeSample a sample of the record).
DirectionalSea directional_sea(const std::vector<ImuSample>& samples,
                               const std::vector<AttitudeSample>& attitude, const CompassSettings& compass);

class Directional : public Method {
 public:
  explicit Directional(const MethodSettings& settings) : settings_(settings) {}
  void add(const ImuSample& sample, Output& output) override;
  void finish(Output& output) override;

 private:
  MethodSettings settings_;
  Record record_;
  bool is_dead(const ImuSample& sample);  // its magnetometer

  Vector3d last_m_B_uT_ = Vector3d::Zero();
  std::int64_t changed_utime_ = 0;
  bool has_field_ = false;
};

}  // namespace waverig::estimator
