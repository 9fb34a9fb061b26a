// Every channel name of waverig, once.
#pragma once
#include <string>
#include <string_view>

namespace waverig::channel {

inline constexpr std::string_view kImu = "WAVERIG_IMU";        // imu_t
inline constexpr std::string_view kCounts = "WAVERIG_COUNTS";  // counts_t
inline constexpr std::string_view kTruth = "WAVERIG_TRUTH";    // truth_t
inline constexpr std::string_view kAxis = "WAVERIG_AXIS";      // axis_t
inline constexpr std::string_view kRun = "WAVERIG_RUN";        // run_t
inline constexpr std::string_view kRecord = "WAVERIG_RECORD";  // record_t
inline constexpr std::string_view kAlarm = "WAVERIG_ALARM";    // alarm_t

// Per method: heave_t, wave_t, sea_t on a channel of the method's own name.
inline constexpr std::string_view kHeavePrefix = "WAVERIG_HEAVE_";
inline constexpr std::string_view kWavePrefix = "WAVERIG_WAVE_";
inline constexpr std::string_view kSeaPrefix = "WAVERIG_SEA_";

inline std::string of_method(std::string_view prefix, std::string_view method) {
  return std::string(prefix).append(method);
}

}  // namespace waverig::channel
