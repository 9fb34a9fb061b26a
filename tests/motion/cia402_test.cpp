#include "motion/cia402.h"

#include <gtest/gtest.h>

namespace waverig::motion {
namespace {

constexpr DriveState kAll[] = {DriveState::kNotReady,         DriveState::kSwitchOnDisabled,
                               DriveState::kReadyToSwitchOn,  DriveState::kSwitchedOn,
                               DriveState::kOperationEnabled, DriveState::kQuickStopActive,
                               DriveState::kFaultReaction,    DriveState::kFault};

DriveStateMachine operating() {
  DriveStateMachine machine;
  for (int i = 0; i < 3; ++i) machine.command(towards_operation(machine.state()));
  return machine;
}

TEST(Cia402, StatuswordTellsEachStateWhateverTheOtherBits) {
  for (const DriveState state : kAll) {
    EXPECT_EQ(state_of(bits_of(state)), state) << name_of(state);
    EXPECT_EQ(state_of(static_cast<std::uint16_t>(bits_of(state) | 0xff90)), state) << name_of(state);
  }
}

TEST(Cia402, ReachesOperationInThreeTransitions) {
  DriveStateMachine machine;
  EXPECT_EQ(machine.state(), DriveState::kSwitchOnDisabled);
  machine.command(0x06);
  EXPECT_EQ(machine.state(), DriveState::kReadyToSwitchOn);
  machine.command(0x07);
  EXPECT_EQ(machine.state(), DriveState::kSwitchedOn);
  machine.command(0x0f);
  EXPECT_EQ(machine.state(), DriveState::kOperationEnabled);
}

TEST(Cia402, DoesNotSkipStates) {
  DriveStateMachine machine;
  machine.command(0x0f);
  EXPECT_EQ(machine.state(), DriveState::kSwitchOnDisabled);
}

TEST(Cia402, QuickStopEndsAtStandstillAndIsNotLeftByEnable) {
  DriveStateMachine machine = operating();
  machine.command(0x02);
  EXPECT_EQ(machine.state(), DriveState::kQuickStopActive);
  machine.command(0x0f);
  EXPECT_EQ(machine.state(), DriveState::kQuickStopActive);
  machine.standstill();
  EXPECT_EQ(machine.state(), DriveState::kSwitchOnDisabled);
}

TEST(Cia402, FaultIsLeftByTheRisingEdgeOfBit7Only) {
  DriveStateMachine machine = operating();
  machine.command(0x8f);  // the bit is high before the fault comes
  machine.fault();
  EXPECT_EQ(machine.state(), DriveState::kFaultReaction);
  machine.standstill();
  EXPECT_EQ(machine.state(), DriveState::kFault);
  machine.command(0x80);
  EXPECT_EQ(machine.state(), DriveState::kFault);
  machine.command(0x00);
  machine.command(0x0f);
  EXPECT_EQ(machine.state(), DriveState::kFault);
  machine.command(0x80);
  EXPECT_EQ(machine.state(), DriveState::kSwitchOnDisabled);
}

TEST(Cia402, DisableVoltageSwitchesOffFromEverywhereButFaults) {
  DriveStateMachine machine = operating();
  machine.command(0x00);
  EXPECT_EQ(machine.state(), DriveState::kSwitchOnDisabled);
}

}  // namespace
}  // namespace waverig::motion
