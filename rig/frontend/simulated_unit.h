// SimulatedUnit: the sensor unit from its motion to frame bytes. It speaks only what the hardware speaks:
// frames of raw counts, so that acquisition and calibration are really exercised.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "motion/kinematics/body_motion.h"
#include "motion/kinematics/earth.h"
#include "rig/frontend/charge_balance.h"
#include "rig/frontend/frame_codec.h"
#include "rig/sensors/accelerometer.h"
#include "rig/sensors/gyroscope.h"
#include "rig/sensors/magnetometer.h"

namespace waverig::rig {

// The front end of the accelerometer: a voltage-to-current stage and a charge-balance converter a channel.
// Nominal values, the same for each channel; how a unit scatters about them.
struct FrontEndSettings {
  double transconductance_ApV = 20e-3;  // 4 g, 1.232 V, make 24.6 mA: the range of Kim, Table 1
  double quantum_C = 24.2e-3 / 256e3;   // 24.2 mA make 256 kHz
  double largest_rate_Hz = 280e3;
  double transconductance_sigma = 0;  // relative
  double scale_sigma = 0;             // of each reset current, relative: DSF_PPP, DSF_NPP
  double bias_sigma_A = 0;
  double reset_clock_error = 0;   // df_AF
  double master_clock_error = 0;  // df_MSTR: a fast master oscillator makes intervals short
};

// A place that neither turns nor curves.
inline LocalEarth flat_earth(double gravity_mps2) {
  constexpr double kFlat = std::numeric_limits<double>::infinity();
  return {.g_N = {0, 0, gravity_mps2}, .north_radius_m = kFlat, .east_radius_m = kFlat};
}

struct UnitSettings {
  AccelerometerSettings accelerometer;
  GyroscopeSettings gyroscope;
  std::optional<MagnetometerSettings> magnetometer;  // none: the unit has no compass
  FrontEndSettings front_end;
  TemperatureSettings temperature;
  double sample_interval_s = 0.01;
  LocalEarth earth = flat_earth(kStandardGravity);  // at the rig; local_earth(place) for a real one
  std::int64_t power_up_utime = 0;                  // its temperature runs from here
};

// MMA7331LC, FXAS21000 and an uncalibrated front end (scale within 500 ppm, bias within 0.5 uA), in a
// laboratory.
UnitSettings datasheet_unit();
// Nothing but quantisation: exact sensors on an exact converter.
UnitSettings ideal_unit();

// One drawn unit: the simulator's truth.
struct UnitParameters {
  AccelerometerParameters accelerometer;
  GyroscopeParameters gyroscope;
  std::array<ConverterChannelSettings, 3> converter;
  Vector3d transconductance_ApV = Vector3d::Ones();
  MagnetometerParameters magnetometer;
};

UnitParameters draw_unit(const UnitSettings& settings, std::uint64_t unit_seed);

// What age does to a calibrated unit; standard deviations per axis (per element of M).
struct AgeingSettings {
  double accel_bias_mps2 = 0.4e-3 * kStandardGravity;
  double accel_scale = 1e-3;
  double accel_misalignment = 1e-3;
  double gyro_offset_radps = 0.2 * kDegree;
};
UnitParameters aged(const UnitParameters& unit, const AgeingSettings& ageing, std::uint64_t seed);

// Bits of the frame's status field; the third: there is a magnetometer, and it is not beyond its range.
inline constexpr std::int64_t kStatusOverload = 1, kStatusGyroLimit = 2, kStatusMagnetometer = 4;

class SimulatedUnit {
 public:
  // noise_seed: of what differs from run to run; the unit itself stays the one given.
  SimulatedUnit(const UnitSettings& settings, const UnitParameters& unit, std::uint64_t noise_seed,
                const FrameLayout& layout = default_frame_layout());

  // The motion as it is dt_s after the last call, linear between; appends a frame for each sample that became
  // due. The first call, with dt_s = 0, sets the beginning of the first counting interval.
  void step(const BodyMotion& motion, double dt_s, std::vector<std::uint8_t>& out);

  // One-sided density of the accelerometer's white noise, m/s^2 per sqrt(Hz), really used.
  double accel_noise_density_mps2() const { return settings_.accelerometer.noise_density_mps2; }
  double gyro_noise_density_radps() const { return settings_.gyroscope.noise_density_radps; }
  const UnitParameters& unit() const { return unit_; }
  const UnitSettings& settings() const { return settings_; }

 private:
  struct Felt {  // what the sensors answer to at one instant
    Vector3d f_B = Vector3d::Zero(), w_B = Vector3d::Zero(), output_mps2 = Vector3d::Zero();
  };
  Felt feel(const BodyMotion& motion, double dt_s);
  void begin_interval();
  void integrate(const Felt& from, const Felt& to, double piece_s);
  void end_interval(std::vector<std::uint8_t>& out);

  UnitSettings settings_;
  UnitParameters unit_;
  FrameEncoder encoder_;
  Accelerometer accelerometer_;
  Gyroscope gyroscope_;
  std::array<ChargeBalanceConverter, 3> converter_;
  Vector3d current_ApMps2_;  // sensor and stage: current a specific force makes
  std::optional<Magnetometer> magnetometer_;
  std::array<std::size_t, 16> slot_;  // where each value stands in the frame
  std::vector<std::int64_t> raw_;

  double true_interval_s_;                         // by the unit's own clock it is sample_interval_s
  std::int64_t interval_us_, interval_utime_ = 0;  // of the unit's clock
  std::int64_t counter_ = 0;
  double phase_s_ = 0;  // since the interval began
  double temperature_degC_ = kReferenceTemperature_degC;
  bool started_ = false, sampled_ = false;
  Felt felt_;
  GyroscopeReading gyro_;
  Eigen::Vector3i mag_ = Eigen::Vector3i::Zero();
};

}  // namespace waverig::rig
