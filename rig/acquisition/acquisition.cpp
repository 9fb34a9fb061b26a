#include "rig/acquisition/acquisition.h"

#include <limits>

#include "lcmtypes/flags.h"
#include "rig/frontend/simulated_unit.h"

namespace waverig::rig {
namespace {

constexpr std::array<const char*, 15> kSlots{"utime",
                                             "accel_positive_x",
                                             "accel_positive_y",
                                             "accel_positive_z",
                                             "accel_negative_x",
                                             "accel_negative_y",
                                             "accel_negative_z",
                                             "gyro_x",
                                             "gyro_y",
                                             "gyro_z",
                                             "mag_x",
                                             "mag_y",
                                             "mag_z",
                                             "temperature",
                                             "status"};
enum Slot : std::size_t {
  kUtime,
  kPositive,
  kNegative = 4,
  kGyro = 7,
  kMag = 10,
  kTemperature = 13,
  kStatus
};

// A sample this near to the range has stood at it for most of its interval.
constexpr double kNearRange = 0.97;

}  // namespace

Sensitivities nominal_sensitivities(const UnitSettings& settings) {
  Sensitivities s;
  s.sample_interval_s = settings.sample_interval_s;
  s.positive_quantum_C.setConstant(settings.front_end.quantum_C);
  s.negative_quantum_C.setConstant(settings.front_end.quantum_C);
  s.current_per_accel_ApMps2 =
      settings.accelerometer.sensitivity_VpMps2 * settings.front_end.transconductance_ApV;
  s.accel_range_mps2 = settings.accelerometer.range_mps2;
  s.gyro_count_radps = gyroscope_count_radps(settings.gyroscope);
  if (settings.magnetometer) s.mag_count_uT = magnetometer_count_uT(*settings.magnetometer);
  return s;
}

Acquisition::Acquisition(const Sensitivities& s, const FrameLayout& layout)
    : sensitivities_(s),
      decoder_(layout),
      slot_{},
      worth_(worth_at(0)),
      saturation_mps2_(kNearRange * s.accel_range_mps2) {
  for (std::size_t i = 0; i < kSlots.size(); ++i) slot_[i] = layout.index_of(kSlots[i]);
  temperature_field_ = layout.fields[slot_[kTemperature]];
}

void Acquisition::apply(const estimator::AccelerometerCalibration& accelerometer,
                        const estimator::GyroscopeCalibration& gyroscope) {
  accelerometer_ = estimator::AccelerometerCorrection(accelerometer);
  gyro_offset_radps_ = gyroscope.offset_radps;
  calibrated_ = true;
}

void Acquisition::apply(const estimator::CompassCalibration& compass) {
  magnetic_gain_ = compass.field_uT * compass.correction.gain;
  magnetic_offset_uT_ = compass.correction.offset;
}

void Acquisition::apply(const estimator::FrontEndCalibration& front_end,
                        const std::array<std::string, 3>& channels) {
  channels_.clear();
  for (const std::string& name : channels) channels_.push_back(front_end.channel(name));
  oscillator_ = front_end.oscillator;
  worth_temperature_ = std::numeric_limits<std::int32_t>::min();  // of no frame
}

Acquisition::Worth Acquisition::worth_at(double temperature_degC) const {
  const Sensitivities& s = sensitivities_;
  const double per_count = 1 / (s.sample_interval_s * s.current_per_accel_ApMps2);
  if (channels_.empty())
    return {s.positive_quantum_C * per_count, s.negative_quantum_C * per_count,
            s.converter_bias_A / s.current_per_accel_ApMps2};
  // A fast master clock makes intervals short: the same counts are a higher rate.
  const double rate_per_count =
      estimator::count_rate_Hz(1, s.sample_interval_s, 1 / (1 + oscillator_.at(temperature_degC)));
  Worth worth;
  for (int i = 0; i < 3; ++i) {
    const estimator::FrontEndChannel& channel = channels_[static_cast<std::size_t>(i)];
    worth.positive_mps2[i] = channel.K_P_C(temperature_degC) * rate_per_count / s.current_per_accel_ApMps2;
    worth.negative_mps2[i] = channel.K_N_C(temperature_degC) * rate_per_count / s.current_per_accel_ApMps2;
    worth.bias_mps2[i] = channel.bias_A.at(temperature_degC) / s.current_per_accel_ApMps2;
  }
  return worth;
}

UnitCounts Acquisition::counts_of(const Frame& frame) const {
  const auto raw = [&](std::size_t slot) { return frame.raw[slot_[slot]]; };
  UnitCounts counts;
  counts.utime = raw(kUtime);
  counts.seq = frame.sequence;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    counts.accel_positive[i] = static_cast<std::int32_t>(raw(kPositive + k));
    counts.accel_negative[i] = static_cast<std::int32_t>(raw(kNegative + k));
    counts.gyro[i] = static_cast<std::int32_t>(raw(kGyro + k));
    counts.mag[i] = static_cast<std::int32_t>(raw(kMag + k));
  }
  counts.temperature = static_cast<std::int32_t>(raw(kTemperature));
  const std::int64_t status = raw(kStatus);
  if (frame.missing > 0) counts.flags |= flag::kGap;
  if ((status & (kStatusOverload | kStatusGyroLimit)) != 0) counts.flags |= flag::kSaturation;
  if ((status & kStatusMagnetometer) == 0) counts.flags |= flag::kNoMagnetometer;
  return counts;
}

estimator::ImuSample Acquisition::sample_of(const UnitCounts& counts) {
  if (new_record_) first_seq_ = counts.seq;
  estimator::ImuSample sample;
  sample.utime = counts.utime;
  sample.seq = counts.seq - first_seq_;
  sample.flags = counts.flags;
  if (new_record_) sample.flags &= ~flag::kGap;  // what is missing lies before the record
  new_record_ = false;

  // i_SEN = K_N C_N - K_P C_P + i_AFbias, Kim eq. (1), referred to the sensor's input.
  if (!channels_.empty() && counts.temperature != worth_temperature_) {
    worth_temperature_ = counts.temperature;
    worth_ = worth_at(temperature_field_.value(counts.temperature));
  }
  const Vector3d f_m = worth_.negative_mps2.cwiseProduct(counts.accel_negative.cast<double>()) -
                       worth_.positive_mps2.cwiseProduct(counts.accel_positive.cast<double>()) +
                       worth_.bias_mps2;
  if (saturation_mps2_ > 0 && f_m.cwiseAbs().maxCoeff() >= saturation_mps2_)
    sample.flags |= flag::kSaturation;
  sample.f_B = accelerometer_(f_m);
  sample.w_NB_B = sensitivities_.gyro_count_radps * counts.gyro.cast<double>() - gyro_offset_radps_;
  if ((counts.flags & flag::kNoMagnetometer) == 0)
    sample.m_B_uT =
        magnetic_gain_ * (sensitivities_.mag_count_uT * counts.mag.cast<double>() - magnetic_offset_uT_);
  sample.temperature_degC = temperature_field_.value(counts.temperature);
  if (!calibrated_) sample.flags |= flag::kUncalibrated;
  return sample;
}

}  // namespace waverig::rig
