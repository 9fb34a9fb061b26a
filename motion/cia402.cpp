#include "motion/cia402.h"

namespace waverig::motion {

std::string_view name_of(DriveState state) {
  switch (state) {
    case DriveState::kNotReady:
      return "Not ready to switch on";
    case DriveState::kSwitchOnDisabled:
      return "Switch on disabled";
    case DriveState::kReadyToSwitchOn:
      return "Ready to switch on";
    case DriveState::kSwitchedOn:
      return "Switched on";
    case DriveState::kOperationEnabled:
      return "Operation enabled";
    case DriveState::kQuickStopActive:
      return "Quick stop active";
    case DriveState::kFaultReaction:
      return "Fault reaction active";
    case DriveState::kFault:
      break;
  }
  return "Fault";
}

DriveState state_of(std::uint16_t word) {
  switch (word & 0x4f) {
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0f:
      return DriveState::kFaultReaction;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (word & 0x6f) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStopActive;
    default:
      return DriveState::kNotReady;
  }
}

std::uint16_t bits_of(DriveState state) {
  switch (state) {
    case DriveState::kNotReady:
      return 0x00;
    case DriveState::kSwitchOnDisabled:
      return 0x40;
    case DriveState::kReadyToSwitchOn:
      return 0x21;
    case DriveState::kSwitchedOn:
      return 0x23 | statusword::kVoltageEnabled;
    case DriveState::kOperationEnabled:
      return 0x27 | statusword::kVoltageEnabled;
    case DriveState::kQuickStopActive:
      return 0x07 | statusword::kVoltageEnabled;
    case DriveState::kFaultReaction:
      return 0x0f | statusword::kVoltageEnabled;
    case DriveState::kFault:
      break;
  }
  return 0x08;
}

std::uint16_t towards_operation(DriveState state) {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return controlword::kShutdown;
    case DriveState::kReadyToSwitchOn:
      return controlword::kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return controlword::kEnableOperation;
    default:
      return controlword::kDisableVoltage;
  }
}

void DriveStateMachine::command(std::uint16_t word) {
  const bool reset_edge = (word & 0x80) != 0 && (last_controlword_ & 0x80) == 0;
  last_controlword_ = word;
  if (state_ == DriveState::kFault) {
    if (reset_edge) state_ = DriveState::kSwitchOnDisabled;
    return;
  }
  if (state_ == DriveState::kFaultReaction || state_ == DriveState::kNotReady) return;

  if ((word & 0x02) == 0) {  // disable voltage
    state_ = DriveState::kSwitchOnDisabled;
  } else if ((word & 0x04) == 0) {  // quick stop
    if (state_ == DriveState::kOperationEnabled)
      state_ = DriveState::kQuickStopActive;
    else if (state_ != DriveState::kQuickStopActive)
      state_ = DriveState::kSwitchOnDisabled;
  } else if (state_ == DriveState::kQuickStopActive) {
    return;                         // only disable voltage, a fault or standstill leave it
  } else if ((word & 0x01) == 0) {  // shutdown
    state_ = DriveState::kReadyToSwitchOn;
  } else if (state_ == DriveState::kReadyToSwitchOn) {
    state_ = DriveState::kSwitchedOn;
  } else if (state_ != DriveState::kSwitchOnDisabled) {
    state_ = (word & 0x08) != 0 ? DriveState::kOperationEnabled : DriveState::kSwitchedOn;
  }
}

void DriveStateMachine::standstill() {
  if (state_ == DriveState::kQuickStopActive) state_ = DriveState::kSwitchOnDisabled;
  if (state_ == DriveState::kFaultReaction) state_ = DriveState::kFault;
}

}  // namespace waverig::motion
