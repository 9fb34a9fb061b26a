// Synthetic regular waves for tests: an orbit, a tilt, and a sensor with errors, in closed form; kinematics
// only.
//
// Heave = (H/2) sin(phase), along = (H/2) ellipticity cos(phase) in the vertical plane of the azimuth. The
// phase and the amplitude may be modulated; all derivatives are exact.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "estimator/types.h"
#include "motion/kinematics/body_motion.h"
#include "motion/kinematics/random.h"

namespace waverig::testing {

inline constexpr double kPi = std::numbers::pi;

enum class Swing { kLevel, kForced, kPendulum };

struct SyntheticWaves {
  double period_s = 6, height_m = 1;
  double duration_s = 300, rate_Hz = 100;
  double rest_s = 0;       // before
  int ramp_waves = 0;      // raised-cosine start of the arm's rate, this many periods long
  double ellipticity = 1;  // horizontal over vertical amplitude
  double azimuth_rad = 0.3, phase_rad = 0.7;
  double modulation = 0, modulation_period_s = 60;  // of the amplitude, relative
  double chirp_ps = 0;                              // relative change of the frequency per second
  Swing swing = Swing::kLevel;
  double forced_tilt_rad = 3 * kDegree, forced_phase_rad = 0;  // against the heave
  double forced_azimuth_rad = 0;                               // direction of the tilt, in B
  Euler mounting{0.01, -0.02, 0.3};
  double gravity_mps2 = kStandardGravity;
};

struct SensorErrors {
  Matrix3d E = Matrix3d::Zero();  // f_m = f + E f + b
  Vector3d b_mps2 = Vector3d::Zero();
  Vector3d gyro_bias_radps = Vector3d::Zero();
  double gyro_scale = 0;
  double accel_noise_mps2_rthz = 350e-6 * kStandardGravity;  // one-sided
  double gyro_noise_radps_rthz = 0.025 * kDegree;
};

struct SyntheticRecord {
  std::vector<estimator::ImuSample> samples;
  std::vector<double> heave_m;  // truth at the samples
  std::vector<Quaterniond> q_NB;
  double steady_from_s = 0;
};

// Errors with these standard deviations.
inline SensorErrors random_errors(RandomStream& stream, double bias_mps2, double scale, double misalignment,
                                  double gyro_bias_radps) {
  SensorErrors e;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) e.E(i, j) = stream.gaussian(i == j ? scale : misalignment);
    e.b_mps2(i) = stream.gaussian(bias_mps2);
    e.gyro_bias_radps(i) = stream.gaussian(gyro_bias_radps);
  }
  return e;
}

// Phase of the orbit at time t (t = 0 at the end of the rest), its rate and acceleration.
struct Phase {
  double angle = 0, rate = 0, accel = 0;
};
inline Phase phase_at(const SyntheticWaves& s, double t) {
  const double w = 2 * kPi / s.period_s;
  if (t < -1e-3) return {s.phase_rad, 0, 0};
  const double ramp = s.ramp_waves * s.period_s;
  if (ramp > 0 && t < ramp) {  // rate w (1 - cos(pi t / ramp)) / 2
    const double k = kPi / ramp;
    return {s.phase_rad + 0.5 * w * (t - std::sin(k * t) / k), 0.5 * w * (1 - std::cos(k * t)),
            0.5 * w * k * std::sin(k * t)};
  }
  const double u = t - ramp;
  return {s.phase_rad + 0.5 * w * ramp + w * (u + 0.5 * s.chirp_ps * u * u), w * (1 + s.chirp_ps * u),
          w * s.chirp_ps};
}

inline BodyMotion motion_at(const SyntheticWaves& s, double t) {
  const Phase p = phase_at(s, t);
  const double r = 0.5 * s.height_m, k = 2 * kPi / s.modulation_period_s;
  const double A = r * (1 + s.modulation * std::sin(k * t)), dA = r * s.modulation * k * std::cos(k * t),
               ddA = -r * s.modulation * k * k * std::sin(k * t);
  const double c = std::cos(p.angle), sn = std::sin(p.angle);
  const double up = A * sn, up_a = ddA * sn + 2 * dA * p.rate * c + A * (p.accel * c - p.rate * p.rate * sn);
  const double along_a =
      s.ellipticity * (ddA * c - 2 * dA * p.rate * sn - A * (p.accel * sn + p.rate * p.rate * c));
  BodyMotion m;
  m.position_N = {s.ellipticity * A * c * std::cos(s.azimuth_rad),
                  s.ellipticity * A * c * std::sin(s.azimuth_rad), -up};
  m.acceleration_N = {along_a * std::cos(s.azimuth_rad), along_a * std::sin(s.azimuth_rad), -up_a};
  Quaterniond tilt = Quaterniond::Identity();
  if (s.swing == Swing::kForced) {
    const double angle =
        s.forced_tilt_rad * std::sin(p.angle + s.forced_phase_rad) * (p.rate > 0 ? 1.0 : 0.0);
    tilt =
        quaternion_exp(angle * Vector3d(std::cos(s.forced_azimuth_rad), std::sin(s.forced_azimuth_rad), 0));
  } else if (s.swing == Swing::kPendulum) {  // hangs along the apparent gravity
    const Vector3d down = Vector3d(0, 0, s.gravity_mps2) - m.acceleration_N;
    tilt = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), down);
  }
  m.q_NB = tilt * quaternion_of(s.mounting);
  return m;
}

inline SyntheticRecord synthesize(const SyntheticWaves& s, const SensorErrors& e, std::uint64_t seed) {
  RandomStream accel_noise(seed, "accel"), gyro_noise(seed, "gyro");
  const double dt = 1 / s.rate_Hz;
  const double accel_sigma = e.accel_noise_mps2_rthz * std::sqrt(0.5 * s.rate_Hz);
  const double gyro_sigma = e.gyro_noise_radps_rthz * std::sqrt(0.5 * s.rate_Hz);
  const Vector3d g_N(0, 0, s.gravity_mps2);
  const auto count = static_cast<std::size_t>((s.rest_s + s.duration_s) * s.rate_Hz);
  SyntheticRecord record;
  record.steady_from_s = s.rest_s + s.ramp_waves * s.period_s;
  record.samples.reserve(count);
  constexpr double kHalf = 1e-4;  // for the angular rate, central difference
  for (std::size_t i = 0; i < count; ++i) {
    const double t_record = static_cast<double>(i) * dt, t = t_record - s.rest_s;
    const BodyMotion m = motion_at(s, t);
    const Quaterniond turn = motion_at(s, t - kHalf).q_NB.conjugate() * motion_at(s, t + kHalf).q_NB;
    const Vector3d w = (turn.w() < 0 ? -1.0 : 1.0) * turn.vec() / kHalf;
    const Vector3d f = specific_force_B(m, g_N);
    estimator::ImuSample sample;
    sample.utime = 1'000'000'000 + std::llround(t_record / kMicrosecond);
    sample.seq = static_cast<std::int64_t>(i);
    sample.f_B =
        f + e.E * f + e.b_mps2 +
        accel_sigma * Vector3d(accel_noise.gaussian(), accel_noise.gaussian(), accel_noise.gaussian());
    sample.w_NB_B =
        (1 + e.gyro_scale) * w + e.gyro_bias_radps +
        gyro_sigma * Vector3d(gyro_noise.gaussian(), gyro_noise.gaussian(), gyro_noise.gaussian());
    record.samples.push_back(sample);
    record.heave_m.push_back(heave_m(m));
    record.q_NB.push_back(m.q_NB);
  }
  return record;
}

}  // namespace waverig::testing
