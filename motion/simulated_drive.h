// A servo drive with gear, arm and brake, simulated: all that stands behind motion::Drive in the simulated
// rig.
//
// Cascaded loops on encoder counts as drives have them: position P, rate P, feed-forward of rate and
// acceleration, and an observer of angle, rate and disturbance (extended state observer; the disturbance is
// compensated, so no integrator winds up). Forces and inertia are given at the arm, after the gear. Time
// passes in advance() only.
#pragma once
#include <cstdint>

#include "motion/cia402.h"
#include "motion/drive.h"
#include "motion/shaft.h"

namespace waverig::motion {

// Zero switches a disturbance off.
struct SimulatedDriveSettings {
  double inertia_kgm2 = 8;  // arm, gondola and rotor
  double rated_torque_Nm = 80;
  double torque_limit_ratio = 2;  // of rated torque
  double viscous_friction_Nms = 1;
  double coulomb_friction_Nm = 1;
  double unbalance_Nm = 3;           // weight of arm and gondola left by the counterweight: times cos(angle)
  double cogging_Nm = 0.5;           // amplitude
  int cogging_per_turn = 384;        // of the arm: 24 a motor turn, gear 16:1
  double counts_per_turn = 1 << 24;  // of the arm: 20 bit a motor turn, gear 16:1
  double initial_angle_rad = 0;      // where the arm stands at first
  double initial_offset_rad = 0;     // what the encoder reads too much until it is homed

  double position_gain_1ps = 15;
  double rate_gain_1ps = 60;      // acceleration per rate error
  double observer_radps = 150;    // bandwidth of the observer
  double interpolation_s = 0.01;  // object 60C2: the controller's period
  double inner_step_s = 1e-3;
  double rate_limit_radps = 10;       // the drive's own, object 6080
  double quick_stop_radps2 = 6;       // object 6085
  double brake_Nm = 200;              // holds and stops the arm when the drive is off
  double watchdog_s = 0.1;            // no exchange for so long: fault 8130h
  double following_window_rad = 0.2;  // object 6065: fault 8611h
  double homing_rate_radps = 0.2;     // object 6099
  double homing_radps2 = 0.5;         // object 609A
  std::uint64_t seed = 1;             // phase of the cogging
};

// What a test or an exercise breaks on purpose; all can be set while the drive runs.
struct DriveFaults {
  bool silent = false;  // exchange throws: the drive does not answer
  bool frozen = false;  // answers with its last answer: hung, but the link lives
  bool late = false;    // answers with the answer of the exchange before
  bool encoder_stuck = false;
  double jam_Nm = 0;             // extra dry friction
  double torque_ratio = 1;       // of the torque that is asked for; 0: the coupling is broken
  double extra_rate_radps = 0;   // runs away: added to the commanded rate
  std::uint16_t error_code = 0;  // not 0: the drive faults with it, once
};

class SimulatedDrive final : public Drive {
 public:
  // Throws UserError where a setting makes no drive.
  explicit SimulatedDrive(const SimulatedDriveSettings& settings = {}, std::int64_t start_utime = 0);

  DriveFeedback exchange(const DriveCommand& command) override;
  DriveFeedback observe() const;  // as an exchange would tell, but nothing is commanded and no watchdog fed
  void advance(double dt_s);      // any length; cut into whole steps of at most inner_step_s

  const ShaftState& shaft() const { return shaft_; }
  DriveState state() const { return machine_.state(); }
  std::int64_t utime() const;
  double torque_Nm() const { return torque_Nm_; }
  const SimulatedDriveSettings& settings() const { return settings_; }
  DriveFaults faults;

 private:
  struct Reference {
    double angle_rad = 0, rate_radps = 0, accel_radps2 = 0;
  };
  struct Observer {
    double angle_rad = 0, rate_radps = 0, disturbance_radps2 = 0;
  };
  struct Segment {
    double end_rate_radps = 0, correction_radps = 0, left_s = 0;
  };

  DriveFeedback process(const DriveCommand& command);
  void take_target(const DriveCommand& command);
  void step(double dt_s);
  void step_cyclic_reference(double dt_s);
  double home_distance_rad() const;
  void finish_homing_if_there();
  void step_homing_reference(double dt_s);
  void step_stop_reference(double dt_s);
  double loop_torque_Nm(const Reference& now, double encoder_rad, double dt_s);
  void step_shaft(double torque_Nm, double dry_friction_Nm, double dt_s);
  void raise_fault(std::uint16_t error_code);
  void catch_reference();
  bool at_standstill() const;
  std::int64_t encoder_counts() const;
  double encoder_rad() const { return static_cast<double>(encoder_counts()) * rad_per_count_; }

  SimulatedDriveSettings settings_;
  double rad_per_count_, counts_per_rad_, cogging_phase_turns_;
  std::int64_t start_utime_;

  DriveStateMachine machine_;
  DriveMode mode_ = DriveMode::kNone;
  std::uint16_t error_code_ = 0;
  bool homing_ = false, homed_ = false, limited_ = false;
  ShaftState shaft_;
  Reference reference_;
  Observer observer_;
  Segment segment_;
  double torque_Nm_ = 0;
  std::int64_t encoder_offset_counts_ = 0, stuck_counts_ = 0;
  double elapsed_s_ = 0, silence_s_ = 0, stopping_s_ = 0;
  DriveFeedback last_feedback_;
};

}  // namespace waverig::motion
