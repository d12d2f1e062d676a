// The drive against its table: every state, every command, every controlword.
#include <optional>

#include "transcript.hpp"

namespace ebac::can::cia402_test {
namespace {

constexpr std::array<DriveState, kDriveStates> kStates{DriveState::kNotReady,
                                                       DriveState::kSwitchOnDisabled,
                                                       DriveState::kReady,
                                                       DriveState::kSwitchedOn,
                                                       DriveState::kOperationEnabled,
                                                       DriveState::kQuickStopActive,
                                                       DriveState::kFaultReaction,
                                                       DriveState::kFault};

/// A controlword per command; the fault reset is the edge from 0.
constexpr std::array<std::int64_t, kDriveCommands> kWords{0x8F, 0x00, 0x02, 0x06, 0x07, 0x0F, 0x80};

/// A drive brought to `state` by what its user can do, its last controlword without bit 7.
SimulatedDrive drive_in(DriveState state) {
  SimulatedDrive drive;
  if (state == DriveState::kNotReady) return drive;
  drive = ready_drive();
  must(drive, 0x605A, 0, 6);  // a quick stop stays
  must(drive, 0x6060, 0, kCyclicTorque);
  const auto ask = [&](std::initializer_list<std::int64_t> words) {
    for (const std::int64_t word : words) must(drive, 0x6040, 0, word);
  };
  if (state == DriveState::kReady) ask({6});
  if (state == DriveState::kSwitchedOn) ask({6, 7});
  if (state == DriveState::kOperationEnabled) ask({6, 7, 15});
  if (state == DriveState::kQuickStopActive) ask({6, 7, 15, 2});
  if (state == DriveState::kFaultReaction || state == DriveState::kFault) {
    drive.set_condition(Condition::kOverVoltage, true);
    drive.set_condition(Condition::kOverVoltage, false);
  }
  if (state == DriveState::kFault) drive.elapse(0);
  return drive;
}

TEST(Cia402, EveryStateTimesEveryCommand) {
  for (const DriveState state : kStates) {
    for (std::size_t command = 0; command < kDriveCommands; ++command) {
      SimulatedDrive drive = drive_in(state);
      ASSERT_EQ(drive.state(), state);
      if (command == 0) {  // bit 7 held: its edge has been
        must(drive, 0x6040, 0, 0x80);
        if (state == DriveState::kFault) continue;  // and has done its work
      }
      must(drive, 0x6040, 0, kWords[command]);
      EXPECT_EQ(drive.state(), after(state, static_cast<DriveCommand>(command)))
          << "state " << static_cast<int>(state) << ", command " << command;
      EXPECT_EQ(
          value(drive, 0x6041) & 0x6F &
              (drive.state() < DriveState::kReady || drive.state() >= DriveState::kFaultReaction
                   ? 0x4F
                   : 0x6F),
          status_bits(drive.state()));
    }
  }
}

TEST(Cia402, TableSaysWhatTheStandardDraws) {
  using S = DriveState;
  using C = DriveCommand;
  // Transitions 2 to 12, 15 and 16 of CiA 402-2, figure 4.
  EXPECT_EQ(after(S::kSwitchOnDisabled, C::kShutdown), S::kReady);
  EXPECT_EQ(after(S::kReady, C::kSwitchOn), S::kSwitchedOn);
  EXPECT_EQ(after(S::kSwitchedOn, C::kEnableOperation), S::kOperationEnabled);
  EXPECT_EQ(after(S::kOperationEnabled, C::kSwitchOn), S::kSwitchedOn);
  EXPECT_EQ(after(S::kSwitchedOn, C::kShutdown), S::kReady);
  EXPECT_EQ(after(S::kReady, C::kDisableVoltage), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kReady, C::kQuickStop), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kOperationEnabled, C::kShutdown), S::kReady);
  EXPECT_EQ(after(S::kOperationEnabled, C::kDisableVoltage), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kSwitchedOn, C::kDisableVoltage), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kOperationEnabled, C::kQuickStop), S::kQuickStopActive);
  EXPECT_EQ(after(S::kQuickStopActive, C::kDisableVoltage), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kFault, C::kFaultReset), S::kSwitchOnDisabled);
  EXPECT_EQ(after(S::kQuickStopActive, C::kEnableOperation), S::kOperationEnabled);
  int moves = 0;
  for (const auto& row : kTransitions) {
    for (const DriveState next : row) moves += next != row[0] ? 1 : 0;
  }
  EXPECT_EQ(moves, 16);  // these, 3 and 4 at once, and the quick stop of Switched on (10)
}

TEST(Cia402, EveryControlwordIsOneCommand) {
  for (std::uint32_t word = 0; word <= 0xFFFF; ++word) {
    const auto w = static_cast<std::uint16_t>(word);
    std::optional<DriveCommand> expected;
    if ((word & 0x80) != 0) expected = DriveCommand::kFaultReset;
    if ((word & 0x82) == 0x00) expected = DriveCommand::kDisableVoltage;
    if ((word & 0x86) == 0x02) expected = DriveCommand::kQuickStop;
    if ((word & 0x87) == 0x06) expected = DriveCommand::kShutdown;
    if ((word & 0x8F) == 0x07) expected = DriveCommand::kSwitchOn;
    if ((word & 0x8F) == 0x0F) expected = DriveCommand::kEnableOperation;
    ASSERT_EQ(command_of(w, 0), expected) << word;
    if ((word & 0x80) != 0) {
      ASSERT_EQ(command_of(w, 0x80), DriveCommand::kNone) << word;
    }
  }
}

TEST(Cia402, FaultResetIsAnEdge) {
  SimulatedDrive drive = drive_in(DriveState::kOperationEnabled);
  must(drive, 0x6040, 0, 0x8F);  // held while there is no fault
  drive.set_condition(Condition::kEncoderLost, true);
  drive.elapse(0);
  drive.set_condition(Condition::kEncoderLost, false);
  must(drive, 0x6040, 0, 0x80);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  must(drive, 0x6040, 0, 0x00);
  must(drive, 0x6040, 0, 0x80);
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(Cia402, FaultStaysWhileItsCauseDoes) {
  SimulatedDrive drive = drive_in(DriveState::kOperationEnabled);
  drive.set_condition(Condition::kOverTemperature, true);
  EXPECT_EQ(drive.state(), DriveState::kFaultReaction);
  drive.elapse(0);
  for (const std::int64_t word : {0x80, 0x00, 0x80}) must(drive, 0x6040, 0, word);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(value(drive, 0x603F), 0x4210);
}

TEST(Cia402, QuickStopLeavesByItselfUnderCodes0To4) {
  for (const auto& [option, stays] :
       {std::pair{0, false}, {1, false}, {2, false}, {5, true}, {6, true}}) {
    SimulatedDrive drive = drive_in(DriveState::kOperationEnabled);
    must(drive, 0x605A, 0, option);
    must(drive, 0x6071, 0, 100);
    must(drive, 0x6040, 0, 2);
    ASSERT_EQ(drive.state(), DriveState::kQuickStopActive);
    const bool ramps = option == 1 || option == 5;  // 1000 permille/s: 100 ms
    EXPECT_EQ(drive.torque(), ramps ? 100 : 0) << option;
    drive.elapse(50 * kMillisecond);
    EXPECT_EQ(drive.torque(), ramps ? 50 : 0) << option;
    must(drive, 0x6040, 0, 15);
    EXPECT_EQ(drive.state() == DriveState::kOperationEnabled, stays) << option;
    must(drive, 0x6040, 0, 2);
    drive.elapse(110 * kMillisecond);
    drive.elapse(0);
    EXPECT_EQ(drive.state(), stays ? DriveState::kQuickStopActive : DriveState::kSwitchOnDisabled)
        << option;
    EXPECT_EQ(drive.current(), 0) << option;
  }
}

TEST(Cia402, NotUnderCanControlNothingIsCommanded) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x2300, 0, 0);
  EXPECT_EQ(value(drive, 0x6041) & statusword::kRemote, 0);
  must(drive, 0x6040, 0, 6);
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(Cia402, NoCurrentUnlessEnabled) {
  for (const DriveState state : kStates) {
    SimulatedDrive drive = drive_in(state);
    must(drive, 0x6071, 0, 500);
    if (state == DriveState::kOperationEnabled) {
      EXPECT_NEAR(drive.current(), 0.4926, 5e-5);  // the paper's example of eq. (1)
      EXPECT_NEAR(drive.current(), copley_current(500, 5300, 5380), 1e-15);
    } else {
      EXPECT_EQ(drive.current(), 0);
    }
  }
}

}  // namespace
}  // namespace ebac::can::cia402_test
