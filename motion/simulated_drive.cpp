#include "motion/simulated_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::motion {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStandstill_radps = 2e-4;
constexpr double kStopGrace_s = 0.5;          // after the quick-stop ramp the brake takes over in any case
constexpr double kReferenceCorrection = 0.2;  // part of the position mismatch taken back in one segment

constexpr std::uint16_t kErrorWatchdog = 0x8130, kErrorFollowing = 0x8611;

// std::floor and std::nearbyint are library calls where the compiler may not assume SSE4.1.
std::int64_t floor_to_int(double x) {
  const auto n = static_cast<std::int64_t>(x);
  return n - (x < static_cast<double>(n) ? 1 : 0);
}

// sin(2 pi x) by its odd Taylor polynomial on a quarter turn: error below 4e-6, plenty for a disturbance.
double sin_turns(double x) {
  x -= static_cast<double>(floor_to_int(x + 0.5));  // [-0.5, 0.5)
  x = x > 0.25 ? 0.5 - x : (x < -0.25 ? -0.5 - x : x);
  const double y = kTurn * x, z = y * y;
  return y * (1 + z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880)))));
}

void require(bool good, const char* key, double value, const char* expected) {
  if (!good) throw UserError(fmt::format("drive: {} = {} is not {}", key, value, expected));
}

}  // namespace

SimulatedDrive::SimulatedDrive(const SimulatedDriveSettings& settings, std::int64_t start_utime)
    : settings_(settings), start_utime_(start_utime) {
  const auto& s = settings_;
  require(s.inertia_kgm2 > 0, "inertia_kgm2", s.inertia_kgm2, "positive");
  require(s.rated_torque_Nm > 0, "rated_torque_Nm", s.rated_torque_Nm, "positive");
  require(s.counts_per_turn >= 1000 && s.counts_per_turn <= (1 << 28), "counts_per_turn", s.counts_per_turn,
          "between 1000 and 2^28");
  require(s.inner_step_s > 0 && s.inner_step_s <= 0.005, "inner_step_s", s.inner_step_s, "in (0, 0.005]");
  require(s.interpolation_s >= s.inner_step_s, "interpolation_s", s.interpolation_s, "at least inner_step_s");
  require(s.quick_stop_radps2 > 0, "quick_stop_radps2", s.quick_stop_radps2, "positive");
  require(s.brake_Nm > std::abs(s.unbalance_Nm) + std::abs(s.cogging_Nm), "brake_Nm", s.brake_Nm,
          "more than unbalance and cogging");
  rad_per_count_ = kTurn / s.counts_per_turn;
  counts_per_rad_ = s.counts_per_turn / kTurn;
  cogging_phase_turns_ = RandomStream(s.seed, "drive cogging").uniform();
  shaft_.angle_rad = s.initial_angle_rad;
  encoder_offset_counts_ = floor_to_int(s.initial_offset_rad * counts_per_rad_);
  catch_reference();
}

std::int64_t SimulatedDrive::utime() const { return start_utime_ + std::llround(elapsed_s_ * 1e6); }

std::int64_t SimulatedDrive::encoder_counts() const {
  if (faults.encoder_stuck) return stuck_counts_;
  return floor_to_int(shaft_.angle_rad * counts_per_rad_) + encoder_offset_counts_;
}

bool SimulatedDrive::at_standstill() const { return std::abs(shaft_.rate_radps) < kStandstill_radps; }

void SimulatedDrive::catch_reference() {
  reference_ = {.angle_rad = encoder_rad(), .rate_radps = 0, .accel_radps2 = 0};
  observer_ = {.angle_rad = reference_.angle_rad, .rate_radps = shaft_.rate_radps, .disturbance_radps2 = 0};
  segment_ = {};
}

void SimulatedDrive::raise_fault(std::uint16_t error_code) {
  if (machine_.state() == DriveState::kFault || machine_.state() == DriveState::kFaultReaction) return;
  error_code_ = error_code;
  homing_ = false;
  machine_.fault();
}

DriveFeedback SimulatedDrive::exchange(const DriveCommand& command) {
  if (faults.silent) throw std::runtime_error("the drive does not answer");
  if (faults.frozen) return last_feedback_;
  const DriveFeedback previous = last_feedback_;
  last_feedback_ = process(command);
  return faults.late ? previous : last_feedback_;
}

DriveFeedback SimulatedDrive::process(const DriveCommand& command) {
  silence_s_ = 0;
  const DriveState before = machine_.state();
  machine_.command(command.controlword);
  const DriveState state = machine_.state();
  if (before == DriveState::kFault && state != DriveState::kFault) error_code_ = 0;
  if (state != before && state == DriveState::kOperationEnabled) catch_reference();

  if (!homing_ && (command.mode == DriveMode::kCyclicPosition || command.mode == DriveMode::kHoming)) {
    if (mode_ != command.mode) {
      homed_ = false;
      segment_ = {};
    }
    mode_ = command.mode;
  }
  if (state != DriveState::kOperationEnabled) homing_ = false;
  if (state == DriveState::kOperationEnabled) {
    if (mode_ == DriveMode::kCyclicPosition) take_target(command);
    if (mode_ == DriveMode::kHoming && (command.controlword & 0x10) != 0 && !homed_) homing_ = true;
  }

  DriveFeedback feedback = observe();
  feedback.sequence = command.sequence;
  return feedback;
}

DriveFeedback SimulatedDrive::observe() const {
  const DriveState state = machine_.state();
  std::uint16_t word = bits_of(state);
  if (limited_) word |= statusword::kInternalLimit;
  if (mode_ == DriveMode::kHoming && homed_) word |= statusword::kHomingAttained | statusword::kTargetReached;
  if (mode_ == DriveMode::kCyclicPosition && state == DriveState::kOperationEnabled)
    word |= statusword::kFollows;
  const double rate_counts = std::clamp(observer_.rate_radps * counts_per_rad_, -2147483647.0, 2147483647.0);
  const double permille = std::clamp(1e3 * torque_Nm_ / settings_.rated_torque_Nm, -32767.0, 32767.0);
  return {.utime = utime(),
          .sequence = last_feedback_.sequence,
          .statusword = word,
          .mode = mode_,
          .position = static_cast<std::int32_t>(static_cast<std::uint32_t>(encoder_counts())),
          .velocity = static_cast<std::int32_t>(std::lrint(rate_counts)),
          .torque_permille = static_cast<std::int16_t>(std::lrint(permille)),
          .error_code = error_code_};
}

// Cyclic synchronous position: be at target when the interpolation time is over, with target_velocity (used
// as feed-forward, object 60B1). The rate runs straight to its end; what the position then lacks is made up
// slowly, so that the counts' steps do not shake the arm.
void SimulatedDrive::take_target(const DriveCommand& command) {
  const std::int64_t here = encoder_counts();
  const auto difference = static_cast<std::int32_t>(static_cast<std::uint32_t>(command.target_position) -
                                                    static_cast<std::uint32_t>(here));
  const double target_rad = static_cast<double>(here + difference) * rad_per_count_;
  const double time_s = settings_.interpolation_s, limit = settings_.rate_limit_radps;
  segment_.left_s = time_s;
  segment_.end_rate_radps = std::clamp(command.target_velocity * rad_per_count_, -limit, limit);
  const double lack_rad =
      target_rad - reference_.angle_rad - 0.5 * (reference_.rate_radps + segment_.end_rate_radps) * time_s;
  segment_.correction_radps = std::clamp(kReferenceCorrection * lack_rad / time_s, -limit, limit);
}

void SimulatedDrive::step_cyclic_reference(double dt_s) {
  auto& r = reference_;
  const double old_rate = r.rate_radps;
  if (segment_.left_s > 0.5 * dt_s) {
    r.accel_radps2 = (segment_.end_rate_radps - r.rate_radps) / std::max(segment_.left_s, dt_s);
    r.rate_radps += r.accel_radps2 * dt_s;
    segment_.left_s -= dt_s;
  } else {  // no new target came: go on at this rate until the watchdog
    r.accel_radps2 = 0;
    segment_.correction_radps = 0;
  }
  r.angle_rad += (0.5 * (old_rate + r.rate_radps) + segment_.correction_radps) * dt_s;
}

// An absolute single-turn sensor on the arm shows the way to angle 0, over the nearer side.
double SimulatedDrive::home_distance_rad() const { return -std::remainder(shaft_.angle_rad, kTurn); }

void SimulatedDrive::finish_homing_if_there() {
  if (!homing_ || std::abs(home_distance_rad()) >= 4 * rad_per_count_ || !at_standstill()) return;
  encoder_offset_counts_ = -std::llround(shaft_.angle_rad / kTurn) * std::llround(settings_.counts_per_turn);
  homing_ = false;
  homed_ = true;
  const double disturbance_radps2 = observer_.disturbance_radps2;  // the load stays when the zero moves
  catch_reference();
  observer_.disturbance_radps2 = disturbance_radps2;
}

void SimulatedDrive::step_homing_reference(double dt_s) {
  auto& r = reference_;
  if (!homing_) {
    r.rate_radps = r.accel_radps2 = 0;
    return;
  }
  const double to_go_rad = home_distance_rad();
  // Braking parabola, run into a proportional approach near the end.
  const double brake_radps = std::sqrt(1.8 * settings_.homing_radps2 * std::abs(to_go_rad));
  const double want =
      std::copysign(std::min({settings_.homing_rate_radps, brake_radps, 3 * std::abs(to_go_rad)}), to_go_rad);
  const double step = settings_.homing_radps2 * dt_s;
  const double change = std::clamp(want - r.rate_radps, -step, step);
  r.accel_radps2 = change / dt_s;
  r.angle_rad += (r.rate_radps + 0.5 * change) * dt_s;
  r.rate_radps += change;
}

void SimulatedDrive::step_stop_reference(double dt_s) {
  auto& r = reference_;
  const double step = settings_.quick_stop_radps2 * dt_s;
  const double change = std::clamp(-r.rate_radps, -step, step);
  r.accel_radps2 = change / dt_s;
  r.angle_rad += (r.rate_radps + 0.5 * change) * dt_s;
  r.rate_radps += change;
}

// All at the begin of the step but the acceleration, which is the step's own.
double SimulatedDrive::loop_torque_Nm(const Reference& now, double encoder_rad, double dt_s) {
  const auto& s = settings_;
  // Han 2009, "From PID to active disturbance rejection control": linear observer, all poles at
  // -observer_radps.
  auto& o = observer_;
  const double w = s.observer_radps, error = encoder_rad + 0.5 * rad_per_count_ - o.angle_rad;
  o.angle_rad += 3 * w * error * dt_s;
  o.rate_radps += 3 * w * w * error * dt_s;
  o.disturbance_radps2 += w * w * w * error * dt_s;

  const double rate_radps = now.rate_radps + segment_.correction_radps + faults.extra_rate_radps +
                            s.position_gain_1ps * (now.angle_rad - encoder_rad);
  const double wanted =
      s.inertia_kgm2 *
      (reference_.accel_radps2 + s.rate_gain_1ps * (rate_radps - o.rate_radps) - o.disturbance_radps2);
  const double limit = s.torque_limit_ratio * s.rated_torque_Nm;
  limited_ = std::abs(wanted) > limit;
  const double torque = std::clamp(wanted, -limit, limit);

  const double accel = torque / s.inertia_kgm2 + o.disturbance_radps2;
  o.angle_rad += (o.rate_radps + 0.5 * accel * dt_s) * dt_s;
  o.rate_radps += accel * dt_s;
  return torque;
}

void SimulatedDrive::step_shaft(double torque_Nm, double dry_friction_Nm, double dt_s) {
  const auto& s = settings_;
  const double turns = shaft_.angle_rad / kTurn, old_rate = shaft_.rate_radps;
  double applied = torque_Nm - s.viscous_friction_Nms * old_rate;
  if (s.unbalance_Nm != 0) applied -= s.unbalance_Nm * sin_turns(turns + 0.25);
  if (s.cogging_Nm != 0)
    applied += s.cogging_Nm * sin_turns(turns * s.cogging_per_turn + cogging_phase_turns_);

  const bool holds = std::abs(applied) <= dry_friction_Nm;
  double rate = old_rate;
  if (old_rate != 0) {
    rate += (applied - std::copysign(dry_friction_Nm, old_rate)) / s.inertia_kgm2 * dt_s;
    if (holds && rate * old_rate < 0) rate = 0;  // friction stops, it never turns back
  } else if (!holds) {
    rate += (applied - std::copysign(dry_friction_Nm, applied)) / s.inertia_kgm2 * dt_s;
  }
  shaft_.accel_radps2 = (rate - old_rate) / dt_s;
  shaft_.angle_rad += 0.5 * (old_rate + rate) * dt_s;
  shaft_.rate_radps = rate;
}

void SimulatedDrive::step(double dt_s) {
  finish_homing_if_there();
  const DriveState state = machine_.state();
  const double encoder = encoder_rad();
  const Reference now = reference_;
  double dry_friction_Nm = settings_.coulomb_friction_Nm + faults.jam_Nm;
  silence_s_ += dt_s;

  if (state == DriveState::kOperationEnabled) {
    stopping_s_ = 0;
    if (mode_ == DriveMode::kHoming) {
      step_homing_reference(dt_s);
    } else {
      step_cyclic_reference(dt_s);
    }
    torque_Nm_ = loop_torque_Nm(now, encoder, dt_s);
    if (silence_s_ > settings_.watchdog_s) raise_fault(kErrorWatchdog);
    if (std::abs(reference_.angle_rad - encoder) > settings_.following_window_rad)
      raise_fault(kErrorFollowing);
  } else if (state == DriveState::kQuickStopActive || state == DriveState::kFaultReaction) {
    segment_ = {};
    step_stop_reference(dt_s);
    torque_Nm_ = loop_torque_Nm(now, encoder, dt_s);
    stopping_s_ += dt_s;
    const bool time_over =
        stopping_s_ > settings_.rate_limit_radps / settings_.quick_stop_radps2 + kStopGrace_s;
    if ((reference_.rate_radps == 0 && at_standstill()) || time_over) machine_.standstill();
  } else {
    torque_Nm_ = 0;
    stopping_s_ = 0;
    limited_ = false;
    dry_friction_Nm += settings_.brake_Nm;
  }
  step_shaft(torque_Nm_ * faults.torque_ratio, dry_friction_Nm, dt_s);
  if (!faults.encoder_stuck) stuck_counts_ = encoder_counts();
}

void SimulatedDrive::advance(double dt_s) {
  if (faults.error_code != 0) {
    raise_fault(faults.error_code);
    faults.error_code = 0;
  }
  const auto steps = static_cast<int>(std::ceil(dt_s / settings_.inner_step_s - 1e-9));
  for (int i = 0; i < steps; ++i) step(dt_s / steps);
  elapsed_s_ += dt_s;
}

}  // namespace waverig::motion
