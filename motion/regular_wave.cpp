#include "motion/regular_wave.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"
#include "motion/tilt.h"

namespace waverig::motion {

using std::numbers::pi;

RegularWave::RegularWave(const RegularWaveSettings& settings) : settings_(settings) {
  const auto require = [](bool good, const char* key, double value, const char* expected) {
    if (!good) throw UserError(fmt::format("wave: {} = {} is not {}", key, value, expected));
  };
  require(settings.period_s > 0, "period_s", settings.period_s, "positive");
  require(settings.height_m >= 0, "height_m", settings.height_m, "zero or more");
  require(settings.amplitude_modulation == 0 || settings.modulation_period_s > 0, "modulation_period_s",
          settings.modulation_period_s, "positive");
}

BodyMotion RegularWave::at(std::int64_t utime) const {
  const auto& s = settings_;
  const double t = 1e-6 * static_cast<double>(utime - s.start_utime);

  // Amplitude, phase, and two derivatives of each.
  double a = 0.5 * s.height_m, a1 = 0, a2 = 0;
  if (s.amplitude_modulation != 0) {
    const double wm = 2 * pi / s.modulation_period_s, depth = a * s.amplitude_modulation;
    a += depth * std::sin(wm * t);
    a1 = depth * wm * std::cos(wm * t);
    a2 = -depth * wm * wm * std::sin(wm * t);
  }
  const double w0 = 2 * pi / s.period_s;
  const double phase = s.phase_rad + w0 * t * (1 + 0.5 * s.frequency_drift_1ps * t);
  const double w = w0 * (1 + s.frequency_drift_1ps * t), w1 = w0 * s.frequency_drift_1ps;
  const double c = std::cos(phase), n = std::sin(phase);

  // up = a cos, along = a sin: the crest runs forward.
  const double up = a * c, up1 = a1 * c - a * w * n, up2 = (a2 - a * w * w) * c - (2 * a1 * w + a * w1) * n;
  const double along = s.orbit_ratio * a * n, along1 = s.orbit_ratio * (a1 * n + a * w * c),
               along2 = s.orbit_ratio * ((a2 - a * w * w) * n + (2 * a1 * w + a * w1) * c);
  const Vector3d way_N(std::cos(s.towards_rad), std::sin(s.towards_rad), 0), up_N(0, 0, -1);

  BodyMotion motion;
  motion.utime = utime;
  motion.position_N = up * up_N + along * way_N;
  motion.velocity_N = up1 * up_N + along1 * way_N;
  motion.acceleration_N = up2 * up_N + along2 * way_N;
  const Vector3d axis_N(-way_N.y(), way_N.x(), 0);
  set_attitude(motion, {.phi_N = s.tilt_rad * n * axis_N,
                        .phi_rate_N = s.tilt_rad * w * c * axis_N,
                        .heading_rad = s.heading_rad});
  return motion;
}

}  // namespace waverig::motion
