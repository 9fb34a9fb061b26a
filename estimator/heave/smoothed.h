// `smoothed`: heave, heave rate, attitude and single waves of a whole record, forward and backward, when it
// ends.
#pragma once
#include "estimator/heave/record_smoother.h"
#include "estimator/method.h"

namespace waverig::estimator {

class Smoothed : public Method {
 public:
  explicit Smoothed(const MethodSettings& settings) : settings_(settings) {}
  void add(const ImuSample& sample, Output&) override { record_.add(sample); }
  void finish(Output& output) override;

 private:
  MethodSettings settings_;
  Record record_;
};

}  // namespace waverig::estimator
