// Coded alarms of the axis: the code goes into axis_t and alarm_t, the text to the reader.
#pragma once
#include <cstdint>
#include <string_view>

namespace waverig::motion {

enum class Alarm : std::int32_t {
  kNone = 0,
  kFollowingError = 1,
  kRateLimit = 2,
  kAccelLimit = 3,
  kJerkLimit = 4,
  kDriveFault = 5,
  kDriveSilent = 6,
  kWrongEcho = 7,
  kStaleFeedback = 8,
  kDriveLeftOperation = 9,
  kEnableTimeout = 10,
  kHomingFailed = 11,
  kDeadlineMissed = 12,
  kEmergencyStop = 13
};

std::string_view text_of(Alarm alarm);

}  // namespace waverig::motion
