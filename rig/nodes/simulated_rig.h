// SimulatedRig: everything from the drive to the frames. It speaks only what the hardware speaks, drive
// registers on one side and frame bytes on the other; the truth it publishes is for the evaluator alone.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/bus.h"
#include "motion/simulated_drive.h"
#include "rig/frontend/simulated_unit.h"
#include "rig/mechanism/rotating_arm.h"

namespace waverig::rig {

struct SimulatedRigSettings {
  motion::SimulatedDriveSettings drive;
  RotatingArmSettings arm;
  double radius_m = 0.5;
  UnitSettings unit;
  double step_s = 2e-3;  // of mechanism and sensors
  double truth_interval_s = 0.01;
  std::uint64_t noise_seed = 1;
};

class SimulatedRig {
 public:
  SimulatedRig(Bus& bus, const SimulatedRigSettings& settings, const UnitParameters& unit,
               std::int64_t start_utime);

  motion::SimulatedDrive& drive() { return drive_; }
  // Lets a time pass and publishes the truth at its end; the bytes stay valid until the next call.
  std::span<const std::uint8_t> advance(double duration_s);
  // The same up to a time, for a rig in real time that is looked at at any moment: the last step may be a
  // short one, and the truth comes every truth_interval_s at the most. Nothing happens where the time has
  // passed already.
  std::span<const std::uint8_t> advance_to(std::int64_t utime);

 private:
  const BodyMotion& step(double step_s, std::int64_t step_us);
  void tell_truth(const BodyMotion& sensor);

  Bus& bus_;
  SimulatedRigSettings settings_;
  motion::SimulatedDrive drive_;
  RotatingArm arm_;
  SimulatedUnit unit_;
  std::int64_t utime_;
  std::int64_t truth_seq_ = 0, next_truth_utime_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace waverig::rig
