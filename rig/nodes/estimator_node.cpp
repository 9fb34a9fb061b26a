#include "rig/nodes/estimator_node.h"

#include <waverig/record_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/flags.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {

EstimatorNode::EstimatorNode(Bus& bus, std::string method, const estimator::MethodSettings& settings)
    : bus_(bus),
      name_(std::move(method)),
      heave_channel_(channel::of_method(channel::kHeavePrefix, name_)),
      wave_channel_(channel::of_method(channel::kWavePrefix, name_)),
      sea_channel_(channel::of_method(channel::kSeaPrefix, name_)),
      settings_(settings) {
  estimator::make_method(name_, settings_);  // an unknown name is refused now, not at the first record
  bus_.subscribe<imu_t>(channel::kImu, [this](const imu_t& m) { take(m); });
  bus_.subscribe<record_t>(channel::kRecord, [this](const record_t& m) {
    m.action == static_cast<std::int32_t>(RecordAction::kBegin) ? begin() : end();
  });
}

// The acquisition hears of a record a moment later than it is said and counts its samples anew from then on:
// what still goes on with the old count lies before the record.
void EstimatorNode::take(const imu_t& m) {
  const std::int64_t missing = count_.missing_before(m.seq);
  if (!method_ || (awaiting_ && !count_.anew())) return;
  estimator::ImuSample sample = estimator::sample_of(m);
  if (missing > 0) sample.flags |= flag::kGap;
  watch_.add(sample);
  samples_missing_ += missing;
  awaiting_ = false;
  method_->add(sample, *this);
}

void EstimatorNode::begin() {
  method_ = estimator::make_method(name_, settings_);
  watch_.begin_record();
  awaiting_ = true;
}

void EstimatorNode::end() {
  if (!method_) return;
  method_->finish(*this);
  method_.reset();
  ++records_;
}
void EstimatorNode::heave(const estimator::HeaveSample& sample) {
  bus_.publish(heave_channel_, message_of(sample));
}
void EstimatorNode::wave(const estimator::Wave& wave) { bus_.publish(wave_channel_, message_of(wave)); }
void EstimatorNode::sea(const estimator::SeaState& sea) { bus_.publish(sea_channel_, message_of(sea)); }

}  // namespace waverig::rig
