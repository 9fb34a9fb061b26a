#include "estimator/compass/tilt_simulation.h"

#include <algorithm>

#include "estimator/compass/error_propagation.h"

namespace waverig::estimator {
namespace {

// atan2 where most errors are small angles: Gregory's series up to t^19 is good to 1e-14 below a quarter, and
// several times faster.
double small_angle(double y, double x) {
  const double t = y / x;
  if (!(x > 0 && std::abs(t) < 0.25)) return std::atan2(y, x);
  const double u = t * t;
  double sum = 1.0 / 19;
  for (int odd = 17; odd >= 1; odd -= 2) sum = 1.0 / odd - u * sum;
  return t * sum;
}

double& at(TiltRun& run, Quantity quantity, std::size_t i) {
  return run.error[static_cast<std::size_t>(quantity)][i];
}

}  // namespace

TiltSweep::TiltSweep(const TiltStudySettings& s) {
  for (int i = 0; i < s.sweep_points; ++i) {
    const double angle = s.sweep_rad * (2.0 * i / (s.sweep_points - 1) - 1);
    const double sn = std::sin(angle), cs = std::cos(angle);
    const Vector3d triad = s.gravity_mps2 * Vector3d(sn, sn * cs, cs * cs);
    tilt.push_back(angle);
    sin_tilt.push_back(sn);
    cos_tilt.push_back(cs);
    ax.push_back(triad.x());
    ay.push_back(triad.y());
    az.push_back(triad.z());
    const TiltError x = linear_tilt_error(triad, Vector3d::UnitX()),
                    y = linear_tilt_error(triad, Vector3d::UnitY()),
                    z = linear_tilt_error(triad, Vector3d::UnitZ());
    roll_ay.push_back(y.roll_rad);
    roll_az.push_back(z.roll_rad);
    pitch_ax.push_back(x.pitch_rad);
    pitch_ay.push_back(y.pitch_rad);
    pitch_az.push_back(z.pitch_rad);
    for (std::size_t c = 0; c < 2; ++c) {
      const Vector3d m_B = field_B(s.heading_rad[c], s.dip_rad, {angle, angle});
      const HeadingGain gain = heading_gain(m_B, {angle, angle});
      cases[c].x.push_back(m_B.x());
      cases[c].y.push_back(m_B.y());
      cases[c].z.push_back(m_B.z());
      cases[c].by_roll.push_back(gain.by_roll);
      cases[c].by_pitch.push_back(gain.by_pitch);
    }
  }
  for (std::size_t c = 0; c < 2; ++c) {
    cases[c].cos_heading = std::cos(s.heading_rad[c]);
    cases[c].sin_heading = std::sin(s.heading_rad[c]);
  }
}

MeanStd mean_std(const Column& values) {
  double sum = 0, square = 0;
  for (const double v : values) {
    sum += v;
    square += v * v;
  }
  const double n = static_cast<double>(values.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, (square - n * mean * mean) / (n - 1)))};
}

TiltSimulation::TiltSimulation(const TiltStudySettings& settings)
    : s_(settings), sweep_(settings), sin_dip_(std::sin(settings.dip_rad)) {}

void TiltSimulation::run(std::int64_t index, TiltRun& run) const {
  RandomStream random(derived_seed(s_.seed, "tilt study", static_cast<std::uint64_t>(index)), "run");
  const std::size_t n = sweep_.points();
  for (Column& column : run.error) column.resize(n);
  for (Column& column : run.predicted) column.resize(n);
  run.z_error.resize(n);
  const Vector3d constant(random.gaussian(s_.accel_error_sigma_mps2),
                          random.gaussian(s_.accel_error_sigma_mps2),
                          random.gaussian(s_.accel_error_sigma_mps2));
  for (std::size_t i = 0; i < n; ++i) point(i, constant, random, run);
  level_turn(random, run);
  run.figures = {mean_std(run.z_error), mean_std(run.turn_dip), mean_std(run.turn_unit_dip)};
}

// One attitude. Sines and cosines of the measured tilt come from the triad itself; the errors as angles
// between measured and true, so that no angle wraps.
void TiltSimulation::point(std::size_t i, const Vector3d& constant, RandomStream& random,
                           TiltRun& run) const {
  const double dx = constant.x() + random.gaussian(s_.accel_noise_mps2);
  const double dy = constant.y() + random.gaussian(s_.accel_noise_mps2);
  const double dz = constant.z() + random.gaussian(s_.accel_noise_mps2);
  const double ax = sweep_.ax[i] + dx, ay = sweep_.ay[i] + dy, az = sweep_.az[i] + dz;
  const double h = std::sqrt(ay * ay + az * az), g = std::sqrt(ax * ax + h * h);
  const double sr = ay / h, cr = az / h, sp = ax / g, cp = h / g;  // eqs. (17), (19)
  const double s0 = sweep_.sin_tilt[i], c0 = sweep_.cos_tilt[i];
  const double roll = small_angle(sr * c0 - cr * s0, cr * c0 + sr * s0);
  const double pitch = small_angle(sp * c0 - cp * s0, cp * c0 + sp * s0);
  const double roll_linear = sweep_.roll_ay[i] * dy + sweep_.roll_az[i] * dz;  // (28)
  const double pitch_linear =
      sweep_.pitch_ax[i] * dx + sweep_.pitch_ay[i] * dy + sweep_.pitch_az[i] * dz;  // (32)
  at(run, Quantity::kRoll, i) = roll;
  at(run, Quantity::kPitch, i) = pitch;
  at(run, Quantity::kRollMiss, i) = roll - roll_linear;
  at(run, Quantity::kPitchMiss, i) = pitch - pitch_linear;
  run.predicted[0][i] = roll_linear;
  run.predicted[1][i] = pitch_linear;

  const double nx = random.gaussian(s_.field_noise), ny = random.gaussian(s_.field_noise),
               nz = random.gaussian(s_.field_noise);
  for (std::size_t c = 0; c < 2; ++c) {
    const TiltSweep::Case& of = sweep_.cases[c];
    const double x = of.x[i] + nx, y = of.y[i] + ny, z = of.z[i] + nz;
    const double down = y * sr + z * cr;
    const double N = -y * cr + z * sr, D = x * cp + down * sp;  // eq. (14)
    const double heading =
        small_angle(N * of.cos_heading - D * of.sin_heading, D * of.cos_heading + N * of.sin_heading);
    const double predicted = of.by_roll[i] * roll + of.by_pitch[i] * pitch;  // eq. (38)
    run.error[static_cast<std::size_t>(Quantity::kHeading1) + c][i] = heading;
    run.error[static_cast<std::size_t>(Quantity::kHeading1Miss) + c][i] = heading - predicted;
    run.predicted[2 + c][i] = predicted;
    if (c == 0) {  // eqs. (23), (24), times cos ph cos th > 0 for the sign
      const double sign_of_z = sin_dip_ + x * sp - y * sr * cp;
      const double magnitude = std::sqrt(std::max(0.0, 1 - x * x - y * y));
      run.z_error[i] = (sign_of_z * cr < 0 ? -magnitude : magnitude) - of.z[i];
    }
  }
}

void TiltSimulation::level_turn(RandomStream& random, TiltRun& run) const {
  const auto n = static_cast<std::size_t>(s_.turn_points);
  run.turn_dip.resize(n);
  run.turn_unit_dip.resize(n);
  const double horizontal = std::cos(s_.dip_rad), vertical = std::sin(s_.dip_rad);
  for (std::size_t i = 0; i < n; ++i) {
    // Round the circle the noise of x and y is the same in every direction: along and across the field's
    // own.
    const double x = horizontal + random.gaussian(s_.field_noise), y = random.gaussian(s_.field_noise);
    const double z = vertical + random.gaussian(s_.field_noise);
    const double level = std::sqrt(x * x + y * y);
    run.turn_dip[i] = std::acos(std::min(1.0, level));  // eq. (25)
    run.turn_unit_dip[i] = std::atan2(z, level);
  }
}

}  // namespace waverig::estimator
