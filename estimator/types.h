// What goes into an estimation method and what comes out of it; the twins of the bus messages in SI and Eigen.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/kinematics/frames.h"

namespace waverig::estimator {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr double square(double x) { return x * x; }

struct ImuSample {
  std::int64_t utime = 0;                 // middle of the measurement interval, microseconds
  std::int64_t seq = 0;
  Vector3d f_B = Vector3d::Zero();        // specific force, m/s^2; level at rest (0, 0, -g)
  Vector3d w_NB_B = Vector3d::Zero();     // angular rate, rad/s
  Vector3d m_B_uT = Vector3d::Zero();     // magnetic field; meaningless with flag::kNoMagnetometer
  double temperature_degC = kUnknown;
  std::int32_t flags = 0;                 // lcmtypes/flags.h
};

struct HeaveSample {
  std::int64_t utime = 0;
  std::int64_t seq = 0;
  double heave_m = 0;                     // up positive
  double heave_rate_mps = 0;
  double heave_sigma_m = kUnknown;        // standard uncertainty (k = 1)
  Quaterniond q_NB = Quaterniond::Identity();
  std::int32_t flags = 0;
};

// One single wave. Standard uncertainties by contribution, as in wave_t: noise_sigma_m is independent from wave to
// wave, the others are common to the waves of a record.
struct Wave {
  std::int64_t start_utime = 0;
  std::int64_t seq = 0;
  double period_s = 0;
  double height_m = 0;
  double noise_sigma_m = kUnknown;
  double calibration_sigma_m = kUnknown;
  double tilt_sigma_m = kUnknown;
  double frequency_sigma_m = kUnknown;
  std::int32_t flags = 0;
};

// Spectral sea state of a record or block, as in sea_t. kUnknown where not estimated; an unknown part of
// hm0_sigma_m is all of it.
struct SeaState {
  std::int64_t start_utime = 0;
  std::int64_t seq = 0;
  double duration_s = kUnknown, hm0_m = kUnknown, hm0_sigma_m = kUnknown, hm0_systematic_sigma_m = kUnknown,
         tp_s = kUnknown, tm01_s = kUnknown, tm02_s = kUnknown, tm_10_s = kUnknown, h13_m = kUnknown,
         h110_m = kUnknown, hmax_m = kUnknown, mean_direction_rad = kUnknown, spread_rad = kUnknown,
         peak_direction_rad = kUnknown, check_factor = kUnknown;
  std::int32_t flags = 0;
};

// The vertical accelerometer's offset changed at once: the sensor was knocked or slipped. Heave is told without it.
struct OffsetChange {
  std::int64_t utime = 0;
  double mps2 = 0;     // by so much the vertical acceleration, up, reads larger from then on
  double sigma_s = 0;  // standard uncertainty of when
};

}  // namespace waverig::estimator
