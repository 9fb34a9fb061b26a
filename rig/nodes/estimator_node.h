// EstimatorNode: one method on the bus. It hears samples and the begin and end of records, nothing else:
// no setting, no truth, no clock.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <waverig/imu_t.hpp>

#include "estimator/method.h"
#include "lcmtypes/bus.h"
#include "rig/nodes/sample_watch.h"
#include "rig/nodes/sequence_watch.h"

namespace waverig::rig {

class EstimatorNode : private estimator::Output {
 public:
  // Throws UserError for an unknown method.
  EstimatorNode(Bus& bus, std::string method, const estimator::MethodSettings& settings);

  bool recording() const { return method_ != nullptr; }
  std::int64_t records() const { return records_; }          // that have ended
  std::int64_t samples() const { return watch_.samples(); }  // of all records
  const SampleWatch& watch() const { return watch_; }        // of all records: what the method leaves out
  std::int64_t samples_missing() const {
    return samples_missing_;
  }  // of all records; the next one carries flag::kGap

 private:
  void take(const imu_t& m);
  void begin();
  void end();
  void heave(const estimator::HeaveSample& sample) override;
  void wave(const estimator::Wave& wave) override;
  void sea(const estimator::SeaState& sea) override;

  Bus& bus_;
  std::string name_, heave_channel_, wave_channel_, sea_channel_;
  estimator::MethodSettings settings_;
  std::unique_ptr<estimator::Method> method_;  // of the record that runs; none between records
  SequenceWatch count_;
  bool awaiting_ = false;  // the record's first sample
  std::int64_t records_ = 0, samples_missing_ = 0;
  SampleWatch watch_;
};

}  // namespace waverig::rig
