// Acquisition: frame bytes to raw counts to calibrated samples, the same for a serial line and for memory.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "estimator/calibration/accelerometer_calibration.h"
#include "estimator/calibration/front_end.h"
#include "estimator/types.h"
#include "rig/frontend/frame_codec.h"

namespace waverig::rig {

// One decoded frame of the sensor unit; the twin of counts_t.
struct UnitCounts {
  std::int64_t utime = 0;  // middle of the counting interval
  std::int64_t seq = 0;    // unwrapped frame counter
  Eigen::Vector3i accel_positive = Eigen::Vector3i::Zero(), accel_negative = Eigen::Vector3i::Zero();
  Eigen::Vector3i gyro = Eigen::Vector3i::Zero(), mag = Eigen::Vector3i::Zero();
  std::int32_t temperature = 0;
  std::int32_t flags = 0;  // lcmtypes/flags.h
};

// What the counts are worth before calibration: the front end's and the sensors' sensitivities, from their
// data sheets or, for the front end, from its own calibration.
struct Sensitivities {
  double sample_interval_s = 0.01;
  Vector3d positive_quantum_C = Vector3d::Constant(1),
           negative_quantum_C = Vector3d::Constant(1);  // K_P, K_N
  Vector3d converter_bias_A = Vector3d::Zero();         // i_AFbias
  double current_per_accel_ApMps2 = 1;                  // sensor and voltage-to-current stage
  double accel_range_mps2 = 0;                          // 0: no limit known
  double gyro_count_radps = 1;
  double mag_count_uT = 0.1;
};

struct UnitSettings;
// The data sheet's figures for a unit of that kind: what a laboratory knows before any calibration.
Sensitivities nominal_sensitivities(const UnitSettings& settings);

// The front end's own calibration (waverig bench), and which of its channels carry x, y and z.
struct FrontEndChoice {
  estimator::FrontEndCalibration calibration;
  std::array<std::string, 3> channels{"accel_1", "accel_2", "accel_3"};
};

class Acquisition {
 public:
  explicit Acquisition(const Sensitivities& sensitivities,
                       const FrameLayout& layout = default_frame_layout());

  // From now on samples are calibrated; without it they carry flag::kUncalibrated.
  void apply(const estimator::AccelerometerCalibration& accelerometer,
             const estimator::GyroscopeCalibration& gyroscope);
  // And the field is freed of the board's iron; its strength stays that of the calibration's place.
  void apply(const estimator::CompassCalibration& compass);
  // From now on the converter's counts are worth what its own calibration says at the unit's temperature,
  // Kim, eqs. (1), (2); channels names those of x, y and z. Throws UserError where the calibration has none
  // of that name. What was found of the sensor with other worths (six positions) does not hold any more.
  void apply(const estimator::FrontEndCalibration& front_end, const std::array<std::string, 3>& channels);
  void apply(const FrontEndChoice& front_end) { apply(front_end.calibration, front_end.channels); }

  // Bytes from the wire, in any pieces; sink(const UnitCounts&, const estimator::ImuSample&) for each intact
  // frame.
  template <class Sink>
  void add(std::span<const std::uint8_t> bytes, Sink&& sink) {
    decoder_.add(bytes);
    while (const Frame* frame = decoder_.next()) {
      const UnitCounts counts = counts_of(*frame);
      sink(counts, sample_of(counts));
    }
  }

  // Counts that were recorded, made samples again: with another calibration, say.
  estimator::ImuSample sample_of(const UnitCounts& counts);

  // The next sample begins a record: its seq is 0.
  void begin_record() { new_record_ = true; }

  const FrameStatistics& statistics() const { return decoder_.statistics(); }

 private:
  struct Worth {  // of one count, and of the converter's bias, referred to the sensor's input
    Vector3d positive_mps2, negative_mps2, bias_mps2;
  };
  UnitCounts counts_of(const Frame& frame) const;
  Worth worth_at(double temperature_degC) const;

  Sensitivities sensitivities_;
  FrameDecoder decoder_;
  std::array<std::size_t, 15> slot_;
  FrameField temperature_field_;
  std::vector<estimator::FrontEndChannel> channels_;  // of x, y, z; empty: the sensitivities' own
  estimator::TemperatureLaw oscillator_;
  Worth worth_;
  std::int32_t worth_temperature_ = 0;
  double saturation_mps2_ = 0;
  estimator::AccelerometerCorrection accelerometer_;
  Vector3d gyro_offset_radps_ = Vector3d::Zero();
  Matrix3d magnetic_gain_ = Matrix3d::Identity();
  Vector3d magnetic_offset_uT_ = Vector3d::Zero();
  bool calibrated_ = false, new_record_ = true;
  std::int64_t first_seq_ = 0;
};

}  // namespace waverig::rig
