#include "rig/frontend/simulated_unit.h"

#include <fmt/format.h>

#include <cmath>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

constexpr double kInstant = 1e-9;  // s: shorter pieces are rounding

constexpr std::array<const char*, 16> kSlots{"counter",
                                             "utime",
                                             "accel_positive_x",
                                             "accel_negative_x",
                                             "accel_positive_y",
                                             "accel_negative_y",
                                             "accel_positive_z",
                                             "accel_negative_z",
                                             "gyro_x",
                                             "gyro_y",
                                             "gyro_z",
                                             "mag_x",
                                             "mag_y",
                                             "mag_z",
                                             "temperature",
                                             "status"};
enum Slot : std::size_t { kCounter, kUtime, kAccel, kGyro = 8, kMag = 11, kTemperature = 14, kStatus };

constexpr double kTemperatureCount_degC = 0.01;

}  // namespace

UnitSettings datasheet_unit() {
  UnitSettings s;
  s.accelerometer = mma7331lc();
  s.gyroscope = fxas21000();
  s.front_end.transconductance_sigma = 1e-3;
  s.front_end.scale_sigma = 500e-6;
  s.front_end.bias_sigma_A = 0.5e-6;
  s.front_end.reset_clock_error = 5e-6;
  s.front_end.master_clock_error = -3e-6;
  s.temperature = laboratory_temperature();
  return s;
}

UnitSettings ideal_unit() {
  UnitSettings s;
  s.accelerometer.sensitivity_VpMps2 = mma7331lc().sensitivity_VpMps2;
  s.gyroscope.lsb_radps = fxas21000().lsb_radps;
  return s;
}

UnitParameters draw_unit(const UnitSettings& settings, std::uint64_t unit_seed) {
  UnitParameters unit{draw_accelerometer(settings.accelerometer, unit_seed),
                      draw_gyroscope(settings.gyroscope, unit_seed),
                      {},
                      Vector3d::Ones(),
                      {}};
  if (settings.magnetometer) unit.magnetometer = draw_magnetometer(*settings.magnetometer, unit_seed);
  const FrontEndSettings& f = settings.front_end;
  RandomStream random(unit_seed, "front end unit");
  for (int i = 0; i < 3; ++i) {
    unit.transconductance_ApV[i] = f.transconductance_ApV * (1 + random.gaussian(f.transconductance_sigma));
    unit.converter[static_cast<std::size_t>(i)] = {f.quantum_C,
                                                   f.quantum_C,
                                                   random.gaussian(f.scale_sigma),
                                                   random.gaussian(f.scale_sigma),
                                                   random.gaussian(f.bias_sigma_A),
                                                   f.reset_clock_error,
                                                   f.largest_rate_Hz};
  }
  return unit;
}

UnitParameters aged(const UnitParameters& unit, const AgeingSettings& ageing, std::uint64_t seed) {
  RandomStream random(seed, "ageing");
  UnitParameters old = unit;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col)
      old.accelerometer.M(row, col) +=
          random.gaussian(row == col ? ageing.accel_scale : ageing.accel_misalignment);
    old.accelerometer.bias_mps2[row] += random.gaussian(ageing.accel_bias_mps2);
    old.gyroscope.offset_radps[row] += random.gaussian(ageing.gyro_offset_radps);
  }
  return old;
}

SimulatedUnit::SimulatedUnit(const UnitSettings& settings, const UnitParameters& unit,
                             std::uint64_t noise_seed, const FrameLayout& layout)
    : settings_(settings),
      unit_(unit),
      encoder_(layout),
      accelerometer_(settings.accelerometer, unit.accelerometer, settings.sample_interval_s, noise_seed),
      gyroscope_(settings.gyroscope, unit.gyroscope, settings.sample_interval_s, noise_seed),
      converter_{ChargeBalanceConverter(unit.converter[0]), ChargeBalanceConverter(unit.converter[1]),
                 ChargeBalanceConverter(unit.converter[2])},
      current_ApMps2_(settings.accelerometer.sensitivity_VpMps2 * unit.transconductance_ApV),
      slot_{},
      raw_(layout.fields.size()),
      true_interval_s_(settings.sample_interval_s / (1 + settings.front_end.master_clock_error)),
      interval_us_(std::llround(settings.sample_interval_s / kMicrosecond)) {
  if (!(settings.sample_interval_s >= 1e-4 && settings.sample_interval_s <= 10))
    throw UserError(fmt::format("sensor unit: sample_interval_s = {}: expected 0.0001 to 10 s",
                                settings.sample_interval_s));
  if (settings.magnetometer) magnetometer_.emplace(*settings.magnetometer, unit.magnetometer, noise_seed);
  for (std::size_t i = 0; i < kSlots.size(); ++i) slot_[i] = layout.index_of(kSlots[i]);
}

SimulatedUnit::Felt SimulatedUnit::feel(const BodyMotion& motion, double dt_s) {
  Felt felt{specific_force_B(motion, settings_.earth), inertial_rate_B(motion, settings_.earth), {}};
  felt.output_mps2 = accelerometer_.respond(felt.f_B, dt_s);
  return felt;
}

void SimulatedUnit::begin_interval() {
  phase_s_ = 0;
  sampled_ = false;
  temperature_degC_ = temperature_degC(
      settings_.temperature, static_cast<double>(interval_utime_ - settings_.power_up_utime) * kMicrosecond);
  accelerometer_.begin_interval(temperature_degC_);
}

void SimulatedUnit::integrate(const Felt& from, const Felt& to, double piece_s) {
  const Vector3d mean = 0.5 * (from.output_mps2 + to.output_mps2) + accelerometer_.interval_noise_mps2();
  for (int i = 0; i < 3; ++i)
    converter_[static_cast<std::size_t>(i)].integrate(mean[i] * current_ApMps2_[i] * piece_s, piece_s);
  phase_s_ += piece_s;
}

void SimulatedUnit::end_interval(std::vector<std::uint8_t>& out) {
  std::int64_t status = gyro_.saturated ? kStatusGyroLimit : 0;
  if (magnetometer_ && !magnetometer_->saturated()) status |= kStatusMagnetometer;
  for (std::size_t i = 0; i < 3; ++i) {
    const ConverterCounts counts = converter_[i].take();
    raw_[slot_[kAccel + 2 * i]] = counts.positive;
    raw_[slot_[kAccel + 2 * i + 1]] = counts.negative;
    raw_[slot_[kGyro + i]] = gyro_.counts[static_cast<int>(i)];
    raw_[slot_[kMag + i]] = mag_[static_cast<int>(i)];
    if (counts.overloaded) status |= kStatusOverload;
  }
  raw_[slot_[kCounter]] = counter_++;
  raw_[slot_[kUtime]] = interval_utime_ + interval_us_ / 2;
  raw_[slot_[kTemperature]] = std::llround(temperature_degC_ / kTemperatureCount_degC);
  raw_[slot_[kStatus]] = status;
  encoder_.append(raw_, out);
  interval_utime_ += interval_us_;
  begin_interval();
}

void SimulatedUnit::step(const BodyMotion& motion, double dt_s, std::vector<std::uint8_t>& out) {
  if (!started_) {
    started_ = true;
    interval_utime_ = motion.utime - std::llround(dt_s / kMicrosecond);
    begin_interval();
    felt_ = feel(motion, 0);
  }
  const Felt before = felt_;
  felt_ = feel(motion, dt_s);
  const auto at = [&](double into_step_s) {
    const double k = dt_s > 0 ? into_step_s / dt_s : 1;
    return Felt{before.f_B + k * (felt_.f_B - before.f_B), before.w_B + k * (felt_.w_B - before.w_B),
                before.output_mps2 + k * (felt_.output_mps2 - before.output_mps2)};
  };
  Felt from = before;
  double done_s = 0;
  while (dt_s - done_s > kInstant) {
    const double piece_s = std::min(dt_s - done_s, true_interval_s_ - phase_s_);
    if (const double middle_s = 0.5 * true_interval_s_ - phase_s_;
        !sampled_ && middle_s <= piece_s + kInstant) {
      const Felt felt = at(done_s + middle_s);
      gyro_ = gyroscope_.sample(felt.w_B, felt.f_B, temperature_degC_);
      if (magnetometer_) mag_ = magnetometer_->sample(motion);
      sampled_ = true;
    }
    done_s += piece_s;
    const Felt to = dt_s - done_s > kInstant ? at(done_s) : felt_;
    integrate(from, to, piece_s);
    from = to;
    if (true_interval_s_ - phase_s_ <= kInstant) end_interval(out);
  }
}

}  // namespace waverig::rig
