#include "rig/nodes/simulated_sea.h"

#include <cmath>

#include "estimator/types.h"
#include "rig/nodes/truth_publisher.h"

namespace waverig::rig {
namespace {

std::int64_t microseconds(double seconds) { return static_cast<std::int64_t>(std::llround(seconds * 1e6)); }

}  // namespace

SimulatedSea::SimulatedSea(Bus& bus, const SimulatedSeaSettings& settings, const UnitParameters& unit,
                           std::int64_t start_utime, const OrderedRun& ordered)
    : bus_(bus),
      settings_(settings),
      buoy_(motion::draw_components(settings.sea), settings.buoy),
      unit_(settings.unit, unit, settings.noise_seed),
      announce_(bus, ordered),
      utime_(start_utime),
      end_utime_(start_utime + microseconds(settings.duration_s)) {
  const BodyMotion start = buoy_.at(utime_);
  unit_.step(start, 0, bytes_);
  announce_.record(utime_, RecordAction::kBegin);
  announce_.phase(utime_, Phase::kSteady);
  publish_truth(bus_, start, truth_seq_++, estimator::kUnknown);
}

std::span<const std::uint8_t> SimulatedSea::advance(double duration_s) {
  bytes_.clear();
  BodyMotion sensor;
  const std::int64_t step_us = microseconds(settings_.step_s);
  for (std::int64_t left_us = microseconds(duration_s); left_us > 0; left_us -= step_us) {
    utime_ += step_us;
    sensor = buoy_.at(utime_);
    unit_.step(sensor, settings_.step_s, bytes_);
  }
  publish_truth(bus_, sensor, truth_seq_++, estimator::kUnknown);
  if (utime_ >= end_utime_ && !finished_) {
    finished_ = true;
    announce_.phase(utime_, Phase::kRest);
    announce_.record(utime_, RecordAction::kEnd);
  }
  return bytes_;
}

}  // namespace waverig::rig
