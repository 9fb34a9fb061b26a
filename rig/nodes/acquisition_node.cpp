#include "rig/nodes/acquisition_node.h"

#include <waverig/counts_t.hpp>
#include <waverig/record_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {
namespace {

counts_t message_of(const UnitCounts& counts) {
  counts_t m{};
  m.utime = counts.utime;
  m.seq = counts.seq;
  for (int i = 0; i < 3; ++i) {
    m.accel_positive_counts[i] = counts.accel_positive[i];
    m.accel_negative_counts[i] = counts.accel_negative[i];
    m.gyro_counts[i] = counts.gyro[i];
    m.mag_counts[i] = counts.mag[i];
  }
  m.temperature_counts = counts.temperature;
  m.flags = counts.flags;
  return m;
}

}  // namespace

AcquisitionNode::AcquisitionNode(Bus& bus, Acquisition acquisition)
    : bus_(bus), acquisition_(std::move(acquisition)) {
  bus_.subscribe<record_t>(channel::kRecord, [this](const record_t& m) {
    if (m.action == static_cast<std::int32_t>(RecordAction::kBegin)) acquisition_.begin_record();
  });
}

void AcquisitionNode::take(std::span<const std::uint8_t> bytes) {
  acquisition_.add(bytes, [this](const UnitCounts& counts, const estimator::ImuSample& sample) {
    bus_.publish(channel::kCounts, message_of(counts));
    bus_.publish(channel::kImu, estimator::message_of(sample));
  });
}

}  // namespace waverig::rig
