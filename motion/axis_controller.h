// The motion controller of the one axis: brings a CiA 402 drive into operation, plays a rotation profile in
// cyclic synchronous position, supervises setpoints, following error, answers and deadlines, and stops the
// drive on every way out. It sees the drive only through motion::Drive.
//
// One cycle() a control period. The setpoint sent at t is the one for t + period: the drive interpolates
// towards it and stands there when the next cycle reads the encoder, so the following error compares equal
// times.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "motion/alarm.h"
#include "motion/cia402.h"
#include "motion/drive.h"
#include "motion/limits.h"
#include "motion/profile.h"
#include "motion/run_clock.h"
#include "motion/setpoint_guard.h"

namespace waverig::motion {

struct AxisSettings {
  double control_period_s = 0.01;
  double counts_per_turn = 1 << 24;  // encoder counts a turn of the arm
  AxisLimits limits{};
  double max_following_error_rad = 0.02;
  int max_missed_exchanges = 2;   // in a row, of one kind; one more raises the alarm
  double max_cycle_gap_s = 0.05;  // between two cycles
  double enable_timeout_s = 2;
  double homing_timeout_s = 120;
  double stop_timeout_s = 5;  // after it the quick stop is followed by disable voltage
  bool homing = false;        // home on enable
  bool check_mode = false;    // dry run: everything but the motion; the drive stays off
};

enum class AxisState { kIdle, kEnabling, kHoming, kReady, kRunning, kStopping, kLocked };
std::string_view name_of(AxisState state);

// The first fields are those of axis_t.
struct AxisStatus {
  std::int64_t utime = 0;
  std::uint16_t statusword = 0;
  Alarm alarm = Alarm::kNone;
  double setpoint_rad = 0;  // for utime
  double measured_rad = 0;
  double following_error_rad = 0;
  double peak_following_error_rad = 0;
  double torque_ratio = 0;

  std::int64_t feedback_utime = 0;  // encoder latch, the drive's clock
  double measured_rate_radps = 0;
  std::uint16_t drive_error = 0;  // object 603F
  AxisState state = AxisState::kIdle;
  RunClock::State hold = RunClock::State::kRunning;
  Phase phase = Phase::kStopped;  // of the run, at utime
  double profile_s = 0;           // time in the profile, at utime
  bool torque_limited = false;
  std::int64_t runs_finished = 0;
  std::int64_t missed_exchanges = 0;  // ever: silent, wrong echo, stale
};

class AxisController {
 public:
  // drive must outlive the controller. Throws UserError where a setting makes no controller.
  AxisController(Drive& drive, const AxisSettings& settings);
  ~AxisController();  // quick stop, if anything moves
  AxisController(const AxisController&) = delete;
  AxisController& operator=(const AxisController&) = delete;

  // Requests; they act in the next cycle. Each throws UserError with the reason where it cannot be granted
  // now.
  void enable();  // from kIdle; homes too, if so set
  void start(const RotationProfile& profile,
             std::int64_t start_utime);  // from kReady; inside the limits only
  void hold();                           // feed hold, as soon as the limits allow; from kRunning
  void resume();
  void acknowledge();  // from kLocked, back to kIdle; resets the drive's fault
  // Always granted.
  void stop();  // quick stop and drive off, no alarm
  void emergency_stop(std::string_view reason);
  void reset_peak() { status_.peak_following_error_rad = 0; }

  const AxisStatus& cycle(std::int64_t utime);

  const AxisStatus& status() const { return status_; }
  const std::string& alarm_message() const {
    return alarm_message_;
  }  // with the numbers; empty without alarm
  const AxisSettings& settings() const { return settings_; }

 private:
  struct Target {
    std::int64_t utime = 0;
    double angle_rad = 0, rate_radps = 0, profile_s = 0;
    Phase phase = Phase::kStopped;
  };

  bool in_operation() const;  // the drive is being brought into, or is in, operation
  bool deadline_kept(std::int64_t utime);
  void advance_target(std::int64_t utime);
  void follow_hold_requests(double t_s);
  DriveCommand next_command();
  std::optional<DriveFeedback> exchange(DriveCommand command);
  void take(const DriveFeedback& feedback);
  void supervise(const DriveFeedback& feedback);
  void next_state(const std::optional<DriveFeedback>& feedback);
  void become(AxisState state);
  void settle_target_here();
  void miss(Alarm alarm, const std::string& why);
  void trip(Alarm alarm, const std::string& message);
  double in_state_s() const;

  Drive& drive_;
  AxisSettings settings_;
  double rad_per_count_, counts_per_rad_;

  AxisStatus status_;
  std::string alarm_message_;
  DriveState drive_state_ = DriveState::kNotReady;
  DriveMode drive_mode_ = DriveMode::kNone;
  DriveMode wanted_mode_ = DriveMode::kCyclicPosition;
  bool cycled_ = false, heard_ = false;
  bool hold_wanted_ = false, resume_wanted_ = false;
  int misses_in_a_row_ = 0, reset_steps_left_ = 0;
  std::uint16_t sequence_ = 0;
  std::int64_t period_us_, state_since_utime_ = 0;
  std::int64_t position_counts_ = 0;  // unwrapped
  Target target_;
  SetpointGuard guard_;
  std::optional<RotationProfile> profile_;
  RunClock clock_;
  std::int64_t run_start_utime_ = 0;
  double run_origin_rad_ = 0;
};

}  // namespace waverig::motion
