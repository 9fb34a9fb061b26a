#include "motion/axis_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>

#include "lcmtypes/error.h"

namespace waverig::motion {
namespace {

// A measured rate ripples about its setpoint; a setpoint may stand at the limit itself.
constexpr double kMeasuredMargin = 1.1;

bool is_off(DriveState state) {
  return state == DriveState::kSwitchOnDisabled || state == DriveState::kReadyToSwitchOn ||
         state == DriveState::kSwitchedOn || state == DriveState::kFault;
}

void require(bool good, const char* key, double value, const char* expected) {
  if (!good) throw UserError(fmt::format("axis: {} = {} is not {}", key, value, expected));
}

[[noreturn]] void refuse(const char* request, const std::string& why) {
  throw UserError(fmt::format("axis: cannot {}: {}", request, why));
}

}  // namespace

std::string_view name_of(AxisState state) {
  switch (state) {
    case AxisState::kIdle:
      return "idle";
    case AxisState::kEnabling:
      return "enabling";
    case AxisState::kHoming:
      return "homing";
    case AxisState::kReady:
      return "ready";
    case AxisState::kRunning:
      return "running";
    case AxisState::kStopping:
      return "stopping";
    case AxisState::kLocked:
      break;
  }
  return "locked by an alarm";
}

AxisController::AxisController(Drive& drive, const AxisSettings& settings)
    : drive_(drive), settings_(settings), guard_(settings.limits) {
  const auto& s = settings_;
  require(s.control_period_s >= 1e-4 && s.control_period_s <= 1, "control_period_s", s.control_period_s,
          "between 0.1 ms and 1 s");
  require(s.counts_per_turn >= 1000, "counts_per_turn", s.counts_per_turn, "at least 1000");
  require(s.limits.rate_radps > 0 && s.limits.accel_radps2 > 0 && s.limits.jerk_radps3 > 0, "limits",
          std::min({s.limits.rate_radps, s.limits.accel_radps2, s.limits.jerk_radps3}), "positive");
  require(s.limits.rate_radps * s.counts_per_turn < 2e9 * 2 * std::numbers::pi, "counts_per_turn",
          s.counts_per_turn, "small enough for 32-bit rates");
  require(s.max_following_error_rad > 0, "max_following_error_rad", s.max_following_error_rad, "positive");
  require(s.max_missed_exchanges >= 0, "max_missed_exchanges", s.max_missed_exchanges, "zero or more");
  require(s.max_cycle_gap_s >= s.control_period_s, "max_cycle_gap_s", s.max_cycle_gap_s,
          "at least control_period_s");
  rad_per_count_ = 2 * std::numbers::pi / s.counts_per_turn;
  counts_per_rad_ = 1 / rad_per_count_;
  period_us_ = std::llround(s.control_period_s * 1e6);
}

AxisController::~AxisController() {
  if (settings_.check_mode || (heard_ && is_off(drive_state_))) return;
  try {
    exchange({.controlword = controlword::kQuickStop, .mode = wanted_mode_});
  } catch (...) {  // nothing more can be done here: the drive's own watchdog stops it
    return;
  }
}

void AxisController::enable() {
  if (status_.state != AxisState::kIdle)
    refuse("enable", fmt::format("the axis is {}", name_of(status_.state)));
  wanted_mode_ = settings_.homing ? DriveMode::kHoming : DriveMode::kCyclicPosition;
  become(AxisState::kEnabling);
}

void AxisController::start(const RotationProfile& profile, std::int64_t start_utime) {
  if (status_.state != AxisState::kReady)
    refuse("start", fmt::format("the axis is {}", name_of(status_.state)));
  if (const auto excess = exceeds(settings_.limits, profile)) refuse("start", excess->sentence());
  profile_ = profile;
  clock_ = {};
  run_start_utime_ = start_utime;
  run_origin_rad_ = target_.angle_rad;
  target_.profile_s = 0;  // not the end of the run before
  hold_wanted_ = resume_wanted_ = false;
  become(AxisState::kRunning);
}

void AxisController::hold() {
  if (status_.state != AxisState::kRunning)
    refuse("hold", fmt::format("the axis is {}", name_of(status_.state)));
  hold_wanted_ = true;
  resume_wanted_ = false;
}

void AxisController::resume() {
  if (status_.state != AxisState::kRunning)
    refuse("resume", fmt::format("the axis is {}", name_of(status_.state)));
  resume_wanted_ = true;
  hold_wanted_ = false;
}

void AxisController::acknowledge() {
  if (status_.state != AxisState::kLocked)
    refuse("acknowledge", fmt::format("the axis is {}", name_of(status_.state)));
  status_.alarm = Alarm::kNone;
  alarm_message_.clear();
  misses_in_a_row_ = 0;
  reset_steps_left_ = 3;
  become(AxisState::kIdle);
}

void AxisController::stop() {
  if (status_.state != AxisState::kIdle && status_.state != AxisState::kLocked) become(AxisState::kStopping);
}

void AxisController::emergency_stop(std::string_view reason) {
  trip(Alarm::kEmergencyStop, std::string(reason));
}

const AxisStatus& AxisController::cycle(std::int64_t utime) {
  // 1. Was the deadline kept, and what should be true now?
  if (!deadline_kept(utime))
    trip(Alarm::kDeadlineMissed, fmt::format("this cycle came {} us after the last, {:.0f} us are allowed",
                                             utime - status_.utime, 1e6 * settings_.max_cycle_gap_s));
  cycled_ = true;
  status_.utime = utime;
  status_.setpoint_rad =
      target_.angle_rad + target_.rate_radps * 1e-6 * static_cast<double>(utime - target_.utime);
  status_.profile_s = target_.profile_s;
  status_.phase = target_.phase;
  // 2. Where to next?
  if (status_.state == AxisState::kReady || status_.state == AxisState::kRunning) advance_target(utime);
  // 3. Tell the drive and hear from it.
  const auto feedback = exchange(next_command());
  // 4. Is all well?
  if (feedback) {
    take(*feedback);
    supervise(*feedback);
  }
  // 5. What follows.
  next_state(feedback);
  return status_;
}

bool AxisController::in_operation() const {
  return status_.state == AxisState::kEnabling || status_.state == AxisState::kHoming ||
         status_.state == AxisState::kReady || status_.state == AxisState::kRunning;
}

double AxisController::in_state_s() const {
  return 1e-6 * static_cast<double>(status_.utime - state_since_utime_);
}

bool AxisController::deadline_kept(std::int64_t utime) {
  if (!cycled_) {
    state_since_utime_ = utime;
    return true;
  }
  const std::int64_t gap_us = utime - status_.utime;
  return gap_us > 0 && (!in_operation() || static_cast<double>(gap_us) <= 1e6 * settings_.max_cycle_gap_s);
}

void AxisController::advance_target(std::int64_t utime) {
  Target next{.utime = utime + period_us_, .angle_rad = target_.angle_rad, .rate_radps = 0};
  if (status_.state == AxisState::kRunning) {
    const double t_s = 1e-6 * static_cast<double>(next.utime - run_start_utime_);
    follow_hold_requests(t_s);
    const RunClock::Reading reading = clock_.read(t_s);
    const ProfilePoint point = eased(*profile_, reading);
    next.angle_rad = run_origin_rad_ + point.angle_rad;
    next.rate_radps = point.rate_radps;
    next.profile_s = reading.profile_s;
    next.phase = point.phase;
  }
  status_.hold = clock_.state();
  if (const auto excess = guard_.check(next.utime, next.angle_rad)) {
    const Alarm alarm = excess->kind == LimitKind::kRate    ? Alarm::kRateLimit
                        : excess->kind == LimitKind::kAccel ? Alarm::kAccelLimit
                                                            : Alarm::kJerkLimit;
    trip(alarm, "setpoint: " + excess->sentence());
    return;
  }
  target_ = next;
}

void AxisController::follow_hold_requests(double t_s) {
  const bool hold = hold_wanted_ && clock_.state() == RunClock::State::kRunning;
  const bool resume = resume_wanted_ && clock_.state() == RunClock::State::kHeld;
  if (!hold && !resume) return;
  const double profile_s = clock_.read(t_s).profile_s;
  const auto ease_s = ease_s_within(settings_.limits, *profile_, profile_s, resume);
  if (!ease_s) return;  // in a ramp at the limits: tried again each cycle
  if (hold) clock_.hold(t_s, *ease_s);
  if (resume) clock_.resume(t_s, *ease_s);
  hold_wanted_ = resume_wanted_ = false;
}

DriveCommand AxisController::next_command() {
  DriveCommand command{
      .mode = wanted_mode_,
      .target_position = static_cast<std::int32_t>(static_cast<std::uint32_t>(position_counts_))};
  switch (status_.state) {
    case AxisState::kIdle:
      if (reset_steps_left_ > 0) --reset_steps_left_;
      command.controlword = reset_steps_left_ == 1 ? controlword::kFaultReset : controlword::kDisableVoltage;
      break;
    case AxisState::kEnabling:
      if (!settings_.check_mode && heard_) command.controlword = towards_operation(drive_state_);
      break;
    case AxisState::kHoming:
      command.controlword = controlword::kHomingStart;
      break;
    case AxisState::kReady:
    case AxisState::kRunning: {
      const std::int64_t counts = std::llround(target_.angle_rad * counts_per_rad_);
      command.target_position = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts));
      command.target_velocity = static_cast<std::int32_t>(std::lrint(target_.rate_radps * counts_per_rad_));
      if (!settings_.check_mode) command.controlword = controlword::kEnableOperation;
      break;
    }
    case AxisState::kStopping:
      command.controlword =
          in_state_s() < settings_.stop_timeout_s ? controlword::kQuickStop : controlword::kDisableVoltage;
      break;
    case AxisState::kLocked:
      command.controlword = controlword::kDisableVoltage;
      break;
  }
  return command;
}

std::optional<DriveFeedback> AxisController::exchange(DriveCommand command) {
  command.sequence = ++sequence_;
  DriveFeedback feedback;
  try {
    feedback = drive_.exchange(command);
  } catch (const std::exception& error) {
    miss(Alarm::kDriveSilent, error.what());
    return std::nullopt;
  }
  if (feedback.sequence != command.sequence) {
    miss(Alarm::kWrongEcho,
         fmt::format("sequence {} was sent and {} came back", command.sequence, feedback.sequence));
    return std::nullopt;
  }
  return feedback;
}

void AxisController::miss(Alarm alarm, const std::string& why) {
  ++status_.missed_exchanges;
  if (++misses_in_a_row_ > settings_.max_missed_exchanges)
    trip(alarm, fmt::format("{} ({} exchanges in a row)", why, misses_in_a_row_));
}

void AxisController::take(const DriveFeedback& feedback) {
  const bool first = !heard_;
  const bool stale = heard_ && feedback.utime == status_.feedback_utime;
  const double dt_s = 1e-6 * static_cast<double>(feedback.utime - status_.feedback_utime);
  heard_ = true;
  drive_state_ = state_of(feedback.statusword);
  drive_mode_ = feedback.mode;
  status_.statusword = feedback.statusword;
  status_.drive_error = feedback.error_code;
  status_.feedback_utime = feedback.utime;
  status_.torque_ratio = 1e-3 * feedback.torque_permille;
  status_.torque_limited = (feedback.statusword & statusword::kInternalLimit) != 0;

  if (first || status_.state == AxisState::kHoming) {
    position_counts_ = feedback.position;  // homing sets the drive's zero
  } else {
    const std::uint32_t last = static_cast<std::uint32_t>(position_counts_);
    position_counts_ += static_cast<std::int32_t>(static_cast<std::uint32_t>(feedback.position) - last);
  }
  const double last_rate_radps = status_.measured_rate_radps;
  status_.measured_rad = static_cast<double>(position_counts_) * rad_per_count_;
  status_.measured_rate_radps = feedback.velocity * rad_per_count_;
  const bool following = status_.state == AxisState::kReady || status_.state == AxisState::kRunning;
  if (!following) status_.setpoint_rad = status_.measured_rad;
  status_.following_error_rad = settings_.check_mode ? 0 : status_.setpoint_rad - status_.measured_rad;
  status_.peak_following_error_rad =
      std::max(status_.peak_following_error_rad, std::abs(status_.following_error_rad));

  if (stale) {
    miss(Alarm::kStaleFeedback, fmt::format("its time stands still at {} us", feedback.utime));
  } else {
    misses_in_a_row_ = 0;
  }
  if (status_.state == AxisState::kHoming && dt_s > 0) {
    const double accel = (status_.measured_rate_radps - last_rate_radps) / dt_s;
    if (!(std::abs(accel) <= kMeasuredMargin * settings_.limits.accel_radps2))
      trip(Alarm::kAccelLimit, fmt::format("measured {:.4g} rad/s^2 in homing, the limit is {:.4g} rad/s^2",
                                           std::abs(accel), settings_.limits.accel_radps2));
  }
}

void AxisController::supervise(const DriveFeedback& feedback) {
  const bool faulted = drive_state_ == DriveState::kFault || drive_state_ == DriveState::kFaultReaction;
  if (faulted && reset_steps_left_ == 0)
    trip(Alarm::kDriveFault, fmt::format("the drive reports error {:04X}h", feedback.error_code));
  if (!in_operation() || settings_.check_mode) return;

  if (std::abs(status_.measured_rate_radps) > kMeasuredMargin * settings_.limits.rate_radps)
    trip(Alarm::kRateLimit, fmt::format("measured {:.4g} rad/s, the limit is {:.4g} rad/s",
                                        std::abs(status_.measured_rate_radps), settings_.limits.rate_radps));
  if (std::abs(status_.following_error_rad) > settings_.max_following_error_rad)
    trip(Alarm::kFollowingError,
         fmt::format("{:.4g} rad at setpoint {:.6g} rad, {:.4g} rad are allowed{}",
                     status_.following_error_rad, status_.setpoint_rad, settings_.max_following_error_rad,
                     status_.torque_limited ? "; the drive is at its torque limit" : ""));
  if (status_.state == AxisState::kEnabling) return;
  if (drive_state_ != DriveState::kOperationEnabled)
    trip(Alarm::kDriveLeftOperation, fmt::format("it is in state {}", name_of(drive_state_)));
  if (drive_mode_ != wanted_mode_)
    trip(Alarm::kDriveLeftOperation,
         fmt::format("mode {} was set and it is in mode {}", static_cast<int>(wanted_mode_),
                     static_cast<int>(drive_mode_)));
}

void AxisController::next_state(const std::optional<DriveFeedback>& feedback) {
  switch (status_.state) {
    case AxisState::kEnabling:
      if (settings_.check_mode && heard_) {
        wanted_mode_ = DriveMode::kCyclicPosition;
        settle_target_here();
        become(AxisState::kReady);
      } else if (feedback && drive_state_ == DriveState::kOperationEnabled && drive_mode_ == wanted_mode_) {
        settle_target_here();
        become(wanted_mode_ == DriveMode::kHoming ? AxisState::kHoming : AxisState::kReady);
      } else if (in_state_s() > settings_.enable_timeout_s) {
        trip(Alarm::kEnableTimeout,
             fmt::format("after {} s it is in state {}, mode {}", settings_.enable_timeout_s,
                         name_of(drive_state_), static_cast<int>(drive_mode_)));
      }
      break;
    case AxisState::kHoming: {
      constexpr std::uint16_t kDone = statusword::kHomingAttained | statusword::kTargetReached;
      if (feedback && (feedback->statusword & statusword::kHomingError) != 0) {
        trip(Alarm::kHomingFailed, "the drive reports a homing error");
      } else if (feedback && (feedback->statusword & kDone) == kDone) {
        wanted_mode_ = DriveMode::kCyclicPosition;
        become(AxisState::kEnabling);  // until the mode has changed
      } else if (in_state_s() > settings_.homing_timeout_s) {
        trip(Alarm::kHomingFailed, fmt::format("not home after {} s", settings_.homing_timeout_s));
      }
      break;
    }
    case AxisState::kRunning:
      if (status_.profile_s >= profile_->duration_s()) {
        ++status_.runs_finished;
        become(AxisState::kReady);
      }
      break;
    case AxisState::kStopping:
      if ((feedback && is_off(drive_state_)) || in_state_s() > 2 * settings_.stop_timeout_s)
        become(status_.alarm == Alarm::kNone ? AxisState::kIdle : AxisState::kLocked);
      break;
    case AxisState::kIdle:
    case AxisState::kReady:
    case AxisState::kLocked:
      break;
  }
}

void AxisController::become(AxisState state) {
  status_.state = state;
  state_since_utime_ = status_.utime;
}

void AxisController::settle_target_here() {
  target_ = {.utime = status_.utime + period_us_, .angle_rad = status_.measured_rad};
  guard_.reset();
}

void AxisController::trip(Alarm alarm, const std::string& message) {
  if (status_.alarm != Alarm::kNone) return;  // the first cause is the one to tell
  status_.alarm = alarm;
  alarm_message_ = fmt::format("alarm {}, {}: {}", static_cast<int>(alarm), text_of(alarm), message);
  become(AxisState::kStopping);
  if (!settings_.check_mode) exchange({.controlword = controlword::kQuickStop, .mode = wanted_mode_});
}

}  // namespace waverig::motion
