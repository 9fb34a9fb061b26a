#include "rig/mechanism/rotating_arm.h"

#include <fmt/format.h>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

// The arm sags by arm_sag cos(angle): its own weight bends it most where it lies horizontal.
motion::ShaftState with_sag(const motion::ShaftState& shaft, double sag_rad) {
  const double c = std::cos(shaft.angle_rad), s = std::sin(shaft.angle_rad), w = shaft.rate_radps;
  return {shaft.angle_rad - sag_rad * c, w + sag_rad * s * w,
          shaft.accel_radps2 + sag_rad * (c * w * w + s * shaft.accel_radps2)};
}

}  // namespace

RotatingArm::RotatingArm(const RotatingArmSettings& settings, double radius_m)
    : settings_(settings),
      radius_m_(radius_m),
      cos_azimuth_(std::cos(settings.azimuth_rad)),
      sin_azimuth_(std::sin(settings.azimuth_rad)),
      inverse_length_(settings.pendulum_length_m > 0 ? 1 / settings.pendulum_length_m : 0),
      natural_radps_(std::sqrt(std::max(0.0, settings.gravity_mps2 * inverse_length_))),
      q_azimuth_(quaternion_of({0, 0, settings.azimuth_rad})),
      q_GB_(quaternion_of(settings.mounting)),
      R_BG_(q_GB_.conjugate().toRotationMatrix()),
      free_(settings.forced_tilt_rad == 0 && settings.pendulum_length_m > 0) {
  if (!(radius_m >= 0) || !std::isfinite(radius_m))
    throw UserError(fmt::format("rig: radius_m = {}: expected a length of at least 0 m", radius_m));
  if (!(settings.pendulum_length_m >= 0) || !std::isfinite(settings.pendulum_length_m))
    throw UserError(fmt::format("rig: pendulum_length_m = {}: expected a length of at least 0 m",
                                settings.pendulum_length_m));
}

double RotatingArm::swing_accel(double angle_rad, double rate_radps, const Pivot& pivot) const {
  return -(pivot.along_mps2 * std::cos(angle_rad) +
           (settings_.gravity_mps2 + pivot.up_mps2) * std::sin(angle_rad)) *
             inverse_length_ -
         2 * natural_radps_ *
             (settings_.pendulum_damping * rate_radps +
              settings_.bearing_damping * (rate_radps - pivot.rate_radps));
}

// One step of the classical Runge-Kutta method; the pivot's motion is linear within the step.
void RotatingArm::swing_freely(const Pivot& before, const Pivot& after, double dt_s) {
  const Pivot middle{0.5 * (before.along_mps2 + after.along_mps2), 0.5 * (before.up_mps2 + after.up_mps2),
                     0.5 * (before.rate_radps + after.rate_radps)};
  const double h = dt_s, x = swing_.angle_rad, v = swing_.rate_radps;
  const double a1 = swing_.accel_radps2;
  const double v2 = v + 0.5 * h * a1;
  const double a2 = swing_accel(x + 0.5 * h * v, v2, middle);
  const double v3 = v + 0.5 * h * a2;
  const double a3 = swing_accel(x + 0.5 * h * v2, v3, middle);
  const double v4 = v + h * a3;
  const double a4 = swing_accel(x + h * v3, v4, after);
  swing_.angle_rad = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
  swing_.rate_radps = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  swing_.accel_radps2 = swing_accel(swing_.angle_rad, swing_.rate_radps, after);
}

void RotatingArm::swing_forced(const motion::ShaftState& arm) {
  const double s = std::sin(arm.angle_rad + settings_.forced_tilt_phase_rad);
  const double c = std::cos(arm.angle_rad + settings_.forced_tilt_phase_rad);
  swing_ = {settings_.forced_tilt_rad * s, settings_.forced_tilt_rad * c * arm.rate_radps,
            settings_.forced_tilt_rad * (c * arm.accel_radps2 - s * arm.rate_radps * arm.rate_radps)};
}

const BodyMotion& RotatingArm::advance(const motion::ShaftState& shaft, double dt_s, std::int64_t utime) {
  const motion::ShaftState arm = settings_.arm_sag_rad == 0 ? shaft : with_sag(shaft, settings_.arm_sag_rad);
  arm_angle_rad_ = arm.angle_rad;

  // 1. The pivot on its circle, in the arm's plane: along the azimuth, and up.
  const double c = std::cos(arm.angle_rad), s = std::sin(arm.angle_rad);
  const double w = arm.rate_radps, w2 = w * w, dw = arm.accel_radps2;
  const Pivot pivot{radius_m_ * (-c * w2 - s * dw), radius_m_ * (-s * w2 + c * dw), w};

  // 2. The gondola on the pivot.
  if (!free_) {
    swing_forced(arm);
  } else if (started_ && dt_s > 0) {
    swing_freely(pivot_, pivot, dt_s);
  } else {  // hanging along apparent gravity
    swing_ = {std::atan2(-pivot.along_mps2, settings_.gravity_mps2 + pivot.up_mps2), 0, 0};
    swing_.accel_radps2 = swing_accel(swing_.angle_rad, 0, pivot);
  }
  pivot_ = pivot;
  started_ = true;

  // 3. The sensor in the gondola: pitch = swing, turning about the gondola's y axis.
  const double ch = std::cos(0.5 * swing_.angle_rad), sh = std::sin(0.5 * swing_.angle_rad);
  const double cp = ch * ch - sh * sh, sp = 2 * sh * ch;
  const Vector3d& l = settings_.lever_arm_G_m;
  const double along = cp * l.x() + sp * l.z(), down = -sp * l.x() + cp * l.z();  // lever arm, levelled
  const double dp = swing_.rate_radps, dp2 = dp * dp, ddp = swing_.accel_radps2;
  const auto in_N = [&](double along_arm, double up) {
    return Vector3d(cos_azimuth_ * along_arm, sin_azimuth_ * along_arm, -up);
  };
  motion_.utime = utime;
  motion_.position_N = in_N(radius_m_ * c + along - l.x(), radius_m_ * s - down + l.z());
  motion_.velocity_N = in_N(-radius_m_ * s * w + dp * down, radius_m_ * c * w + dp * along);
  motion_.acceleration_N =
      in_N(pivot.along_mps2 + ddp * down - dp2 * along, pivot.up_mps2 + ddp * along + dp2 * down);
  motion_.q_NB = q_azimuth_ * Quaterniond(ch, 0, sh, 0) * q_GB_;
  motion_.w_NB_B = R_BG_.col(1) * dp;
  return motion_;
}

}  // namespace waverig::rig
