// The boundary to a drive: what a CiA 402 drive is told and what it tells, one exchange a control cycle.
// Simulator, mock and hardware stand behind the one interface.
#pragma once
#include <cstdint>

namespace waverig::motion {

// CiA 402 modes of operation, object 6060.
enum class DriveMode : std::int8_t {
  kNone = 0,
  kProfilePosition = 1,
  kProfileVelocity = 3,
  kHoming = 6,
  kCyclicPosition = 8,
  kCyclicVelocity = 9
};

struct DriveCommand {
  std::uint16_t sequence = 0;     // echoed by the drive: a late answer is told from the right one
  std::uint16_t controlword = 0;  // object 6040
  DriveMode mode = DriveMode::kCyclicPosition;
  std::int32_t target_position = 0;  // encoder counts, object 607A
  std::int32_t target_velocity = 0;  // encoder counts a second, object 60FF
};

struct DriveFeedback {
  std::int64_t utime = 0;  // time stamp of the encoder latch, at the drive
  std::uint16_t sequence = 0;
  std::uint16_t statusword = 0;       // object 6041
  DriveMode mode = DriveMode::kNone;  // object 6061
  std::int32_t position = 0;          // encoder counts, object 6064
  std::int32_t velocity = 0;          // encoder counts a second, object 606C
  std::int16_t torque_permille = 0;   // of rated torque, object 6077
  std::uint16_t error_code = 0;       // object 603F
};

class Drive {
 public:
  virtual ~Drive() = default;
  // Throws std::runtime_error where the drive does not answer in time or answers something else.
  virtual DriveFeedback exchange(const DriveCommand& command) = 0;
};

}  // namespace waverig::motion
