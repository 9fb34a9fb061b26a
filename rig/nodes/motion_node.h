// MotionNode: the axis controller on the bus. It enables the drive, plays one run's profile, says which phase
// begins, and marks begin and end of the record. One cycle() a control period; whoever calls it owns the
// time.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lcmtypes/bus.h"
#include "motion/axis_controller.h"
#include "rig/nodes/encoder_truth.h"
#include "rig/nodes/run_announcer.h"

namespace waverig::rig {

class MotionNode {
 public:
  // drive must outlive the node, which leaves it stopped on every way out.
  MotionNode(Bus& bus, motion::Drive& drive, const motion::AxisSettings& axis,
             const motion::RotationProfile& profile, const OrderedRun& ordered);

  // Every cycle tells from now on what the encoder says that the arm did: of a real rig, that has nobody else
  // to tell it.
  void tell_truth(const ArmPlacement& arm) { truth_.emplace(bus_, arm); }

  void cycle(std::int64_t utime);
  // The record has ended: done, alarmed or stopped. Whoever has the time goes on with cycle() until
  // at_rest().
  bool finished() const { return finished_; }
  bool at_rest() const;  // the drive is off

  // Requests; they act in the next cycle. A held span is announced as Phase::kHeld.
  void stop() { stop_wanted_ = true; }  // ends the run early: quick stop and drive off
  void hold() { controller_.hold(); }   // feed hold; throws UserError where nothing runs
  void resume() { controller_.resume(); }

  // The alarm that ended the run, with its numbers; empty where there was none.
  const std::string& alarm() const { return controller_.alarm_message(); }
  const motion::AxisStatus& status() const { return controller_.status(); }

 private:
  Phase announced_phase() const;
  void publish_status(std::int64_t utime);
  void publish_alarm(std::int64_t utime, std::string_view text);

  Bus& bus_;
  motion::AxisController controller_;
  motion::RotationProfile profile_;
  RunAnnouncer announce_;
  std::optional<EncoderTruth> truth_;
  motion::AxisState published_state_ = motion::AxisState::kIdle;
  std::int64_t axis_seq_ = 0, alarm_seq_ = 0, next_status_utime_ = 0;
  bool started_ = false, finished_ = false, stop_wanted_ = false;
};

}  // namespace waverig::rig
