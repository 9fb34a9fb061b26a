// CiA 402 (IEC 61800-7-201) device control: states, statusword, controlword, and the drive's side of the
// machine.
#pragma once
#include <cstdint>
#include <string_view>

namespace waverig::motion {

enum class DriveState {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReaction,
  kFault
};

std::string_view name_of(DriveState state);

namespace controlword {
inline constexpr std::uint16_t kDisableVoltage = 0x00;
inline constexpr std::uint16_t kQuickStop = 0x02;
inline constexpr std::uint16_t kShutdown = 0x06;
inline constexpr std::uint16_t kSwitchOn = 0x07;
inline constexpr std::uint16_t kEnableOperation = 0x0f;
inline constexpr std::uint16_t kHomingStart = 0x1f;  // enable operation and bit 4
inline constexpr std::uint16_t kFaultReset = 0x80;   // acts on the rising edge
}  // namespace controlword

namespace statusword {
inline constexpr std::uint16_t kVoltageEnabled = 1 << 4;
inline constexpr std::uint16_t kTargetReached = 1 << 10;
inline constexpr std::uint16_t kInternalLimit = 1 << 11;  // torque or rate is held at a limit
inline constexpr std::uint16_t kFollows = 1 << 12;        // cyclic modes: the drive follows the command value
inline constexpr std::uint16_t kHomingAttained = 1 << 12;  // homing mode
inline constexpr std::uint16_t kHomingError = 1 << 13;
}  // namespace statusword

DriveState state_of(std::uint16_t statusword);
std::uint16_t bits_of(DriveState state);

// The controlword that leads one transition nearer to Operation enabled. Never resets a fault.
std::uint16_t towards_operation(DriveState state);

// The drive's side. Quick stop and fault reaction end at standstill (option codes 605A, 605E = 2).
class DriveStateMachine {
 public:
  DriveState state() const { return state_; }
  void command(std::uint16_t controlword);  // at most one transition
  void fault() {
    if (state_ != DriveState::kFault) state_ = DriveState::kFaultReaction;
  }
  void standstill();  // told while the shaft rests

 private:
  DriveState state_ = DriveState::kSwitchOnDisabled;
  std::uint16_t last_controlword_ = 0;
};

}  // namespace waverig::motion
