// EstimatorNode: one method on the bus. It hears samples and the begin and end of records, nothing else:
// no setting, no truth, no clock.
#pragma once
#include <memory>
#include <string>

#include "estimator/method.h"
#include "lcmtypes/bus.h"

namespace waverig::rig {

class EstimatorNode : private estimator::Output {
 public:
  // Throws UserError for an unknown method.
  EstimatorNode(Bus& bus, std::string method, const estimator::MethodSettings& settings);

 private:
  void begin();
  void end();
  void heave(const estimator::HeaveSample& sample) override;
  void wave(const estimator::Wave& wave) override;
  void sea(const estimator::SeaState& sea) override;

  Bus& bus_;
  std::string name_, heave_channel_, wave_channel_, sea_channel_;
  estimator::MethodSettings settings_;
  std::unique_ptr<estimator::Method> method_;   // of the record that runs; none between records
};

}  // namespace waverig::rig
