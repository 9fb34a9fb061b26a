#include "rig/nodes/motion_node.h"

#include <algorithm>
#include <cstring>
#include <waverig/alarm_t.hpp>
#include <waverig/axis_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {
namespace {

constexpr std::int64_t kStatusPeriod_utime = 100000;  // between two axis_t where nothing changes

}  // namespace

MotionNode::MotionNode(Bus& bus, motion::Drive& drive, const motion::AxisSettings& axis,
                       const motion::RotationProfile& profile, const OrderedRun& ordered)
    : bus_(bus), controller_(drive, axis), profile_(profile), announce_(bus, ordered) {
  controller_.enable();
}

void MotionNode::cycle(std::int64_t utime) {
  using motion::AxisState;
  const auto& status = controller_.cycle(utime);
  if (status.state == AxisState::kReady && !started_) {
    started_ = true;
    const auto period_us = static_cast<std::int64_t>(controller_.settings().control_period_s * 1e6);
    controller_.start(profile_, utime + period_us);
    announce_.record(utime + period_us, RecordAction::kBegin);
  }
  const bool alarmed = status.alarm != motion::Alarm::kNone;
  const bool cut_short = alarmed || stop_wanted_;
  if (started_ && !finished_) announce_.phase(utime, cut_short ? Phase::kStopped : announced_phase());
  publish_status(utime);
  if (truth_) truth_->tell(utime, status.measured_rad);
  if (finished_) return;
  if (cut_short)
    publish_alarm(utime, alarmed ? controller_.alarm_message() : "stopped before the run's end, as told");
  if (cut_short || status.runs_finished > 0) {
    finished_ = true;
    controller_.stop();
    if (started_) announce_.record(utime, RecordAction::kEnd);
  }
}

bool MotionNode::at_rest() const {
  const motion::AxisState state = controller_.status().state;
  return state == motion::AxisState::kIdle || state == motion::AxisState::kLocked;
}

// While the profile's time is held, or eases out of it or back, the wave is not the one that was ordered.
Phase MotionNode::announced_phase() const {
  const auto& status = controller_.status();
  const bool held =
      status.state == motion::AxisState::kRunning && status.hold != motion::RunClock::State::kRunning;
  return held ? Phase::kHeld : status.phase;
}

void MotionNode::publish_status(std::int64_t utime) {
  const auto& status = controller_.status();
  if (status.state == published_state_ && utime < next_status_utime_) return;
  published_state_ = status.state;
  next_status_utime_ = utime + kStatusPeriod_utime;
  axis_t m{};
  m.utime = utime;
  m.seq = axis_seq_++;
  m.statusword = status.statusword;
  m.alarm = static_cast<std::int32_t>(status.alarm);
  m.setpoint_rad = status.setpoint_rad;
  m.measured_rad = status.measured_rad;
  m.following_error_rad = status.following_error_rad;
  m.peak_following_error_rad = status.peak_following_error_rad;
  m.torque_ratio = status.torque_ratio;
  bus_.publish(channel::kAxis, m);
}

void MotionNode::publish_alarm(std::int64_t utime, std::string_view text) {
  constexpr std::int32_t kMotionStops = 2;
  alarm_t m{};
  m.utime = utime;
  m.seq = alarm_seq_++;
  m.code = static_cast<std::int32_t>(controller_.status().alarm);
  m.severity = kMotionStops;
  std::memcpy(m.text, text.data(), std::min(text.size(), sizeof m.text));
  bus_.publish(channel::kAlarm, m);
}

}  // namespace waverig::rig
