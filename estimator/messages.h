// Between the estimator's types and their twins on the bus, both ways. NaN means unknown on either side.
#pragma once
#include <waverig/heave_t.hpp>
#include <waverig/imu_t.hpp>
#include <waverig/sea_t.hpp>
#include <waverig/wave_t.hpp>

#include "estimator/types.h"

namespace waverig::estimator {

inline void put(const Quaterniond& q, double (&out)[4]) {
  out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z();
}
inline Quaterniond quaternion(const double (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }

inline imu_t message_of(const ImuSample& s) {
  imu_t m{};
  m.utime = s.utime;
  m.seq = s.seq;
  Eigen::Map<Vector3d>(m.accel_mps2) = s.f_B;
  Eigen::Map<Vector3d>(m.gyro_radps) = s.w_NB_B;
  Eigen::Map<Vector3d>(m.mag_uT) = s.m_B_uT;
  m.temperature_degC = s.temperature_degC;
  m.flags = s.flags;
  return m;
}

inline ImuSample sample_of(const imu_t& m) {
  return {m.utime,
          m.seq,
          Eigen::Map<const Vector3d>(m.accel_mps2),
          Eigen::Map<const Vector3d>(m.gyro_radps),
          Eigen::Map<const Vector3d>(m.mag_uT),
          m.temperature_degC,
          m.flags};
}

inline heave_t message_of(const HeaveSample& s) {
  heave_t m{};
  m.utime = s.utime;
  m.seq = s.seq;
  m.heave_m = s.heave_m;
  m.heave_rate_mps = s.heave_rate_mps;
  m.heave_sigma_m = s.heave_sigma_m;
  put(s.q_NB, m.quat_NB);
  m.flags = s.flags;
  return m;
}

inline HeaveSample heave_of(const heave_t& m) {
  return {m.utime, m.seq, m.heave_m, m.heave_rate_mps, m.heave_sigma_m, quaternion(m.quat_NB), m.flags};
}

inline wave_t message_of(const Wave& w) {
  wave_t m{};
  m.utime = w.start_utime;
  m.seq = w.seq;
  m.period_s = w.period_s;
  m.height_m = w.height_m;
  m.noise_sigma_m = w.noise_sigma_m;
  m.calibration_sigma_m = w.calibration_sigma_m;
  m.tilt_sigma_m = w.tilt_sigma_m;
  m.frequency_sigma_m = w.frequency_sigma_m;
  m.flags = w.flags;
  return m;
}

inline Wave wave_of(const wave_t& m) {
  return {m.utime,         m.seq,         m.period_s,          m.height_m, m.noise_sigma_m, m.calibration_sigma_m,
          m.tilt_sigma_m, m.frequency_sigma_m, m.flags};
}

inline sea_t message_of(const SeaState& s) {
  sea_t m{};
  m.utime = s.start_utime;
  m.seq = s.seq;
  m.duration_s = s.duration_s;
  m.hm0_m = s.hm0_m;
  m.hm0_sigma_m = s.hm0_sigma_m;
  m.hm0_systematic_sigma_m = s.hm0_systematic_sigma_m;
  m.tp_s = s.tp_s;
  m.tm01_s = s.tm01_s;
  m.tm02_s = s.tm02_s;
  m.tm_10_s = s.tm_10_s;
  m.h13_m = s.h13_m;
  m.h110_m = s.h110_m;
  m.hmax_m = s.hmax_m;
  m.mean_direction_rad = s.mean_direction_rad;
  m.spread_rad = s.spread_rad;
  m.peak_direction_rad = s.peak_direction_rad;
  m.check_factor = s.check_factor;
  m.flags = s.flags;
  return m;
}

inline SeaState sea_of(const sea_t& m) {
  return {m.utime,   m.seq,    m.duration_s, m.hm0_m,  m.hm0_sigma_m,        m.hm0_systematic_sigma_m,
          m.tp_s,    m.tm01_s, m.tm02_s,     m.tm_10_s, m.h13_m,             m.h110_m,
          m.hmax_m,  m.mean_direction_rad,   m.spread_rad, m.peak_direction_rad, m.check_factor, m.flags};
}

}  // namespace waverig::estimator
