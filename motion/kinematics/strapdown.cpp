#include "motion/kinematics/strapdown.h"

namespace waverig {
namespace {

// What the interval before says of the change of rate within this one: the 1/12 of the classic algorithms for
// equal intervals (Savage 1998, eqs. (47), (57)), scaled where they differ. Zero at the first interval.
double history_gain(const Increments& now, const Increments& before) {
  if (!(before.dt_s > 0)) return 0;
  return now.dt_s * now.dt_s / (6 * before.dt_s * (now.dt_s + before.dt_s));
}

Place moved(const Place& place, const LocalEarth& local, const Vector3d& v_N, double dt_s) {
  return {place.latitude_rad + v_N.x() * dt_s / local.north_radius_m,
          place.longitude_rad + v_N.y() * dt_s / (local.east_radius_m * std::cos(place.latitude_rad)),
          place.height_m - v_N.z() * dt_s};
}

}  // namespace

void StrapdownNavigator::add(const Increments& now) {
  const double dt = now.dt_s;
  if (!(dt > 0)) return;
  const double k = history_gain(now, previous_);
  const Vector3d& a = now.angle_B;
  const Vector3d& v = now.velocity_B;

  // Rotation vector with coning; velocity increment in the axes of the interval's start with rotation and
  // sculling.
  const Vector3d rotation_B = a + k * previous_.angle_B.cross(a);
  const Vector3d velocity_B =
      v + 0.5 * a.cross(v) + k * (previous_.angle_B.cross(v) + previous_.velocity_B.cross(a));

  const LocalEarth local = local_earth(state_.place, earth_);
  const Vector3d turn_N = (local.w_ie_N + transport_rate_N(local, state_.velocity_N)) * dt;

  // Velocity, eq. (28): half the frame's turn belongs to the specific force, Coriolis is taken at
  // mid-interval.
  const Vector3d f_N = quaternion_exp(-0.5 * turn_N) * (state_.q_NB * velocity_B) / dt;
  const Vector3d v_mid_N = state_.velocity_N + velocity_rate_N(local, f_N, state_.velocity_N) * (dt / 2);
  const Vector3d v_end_N = state_.velocity_N + velocity_rate_N(local, f_N, v_mid_N) * dt;

  state_.place = moved(state_.place, local, 0.5 * (state_.velocity_N + v_end_N), dt);
  state_.velocity_N = v_end_N;
  state_.q_NB = (quaternion_exp(-turn_N) * state_.q_NB * quaternion_exp(rotation_B)).normalized();
  previous_ = now;
}

}  // namespace waverig
