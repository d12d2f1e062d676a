// The node itself: NMT, heartbeats, EMCY, faults on request, and the torque it makes of a target.
#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "ebac/canopen/eds.hpp"
#include "transcript.hpp"

namespace ebac::can::simulated_drive_test {
namespace {

constexpr std::int64_t kSecond = 1000 * kMillisecond;

TEST(Nmt, StatesAndBootUp) {
  SimulatedDrive drive;
  EXPECT_EQ(heard(drive), Said{"701#00"});
  EXPECT_EQ(drive.nmt(), NmtState::kPreOperational);
  const auto state_after = [&](const std::string& text) {
    say(drive, text);
    return drive.nmt();
  };
  EXPECT_EQ(state_after("000#01 01"), NmtState::kOperational);
  EXPECT_EQ(state_after("000#02 00"), NmtState::kStopped);  // all nodes
  EXPECT_EQ(state_after("000#80 02"), NmtState::kStopped);  // another
  EXPECT_EQ(state_after("000#80 01"), NmtState::kPreOperational);
  EXPECT_EQ(state_after("000#55 01"), NmtState::kPreOperational);  // no such command
  EXPECT_EQ(state_after("000#01"), NmtState::kPreOperational);     // half a command
  EXPECT_EQ(say(drive, "000#82 01"), Said{"701#00"});
  EXPECT_EQ(say(drive, "000#81 00"), Said{"701#00"});
}

TEST(Nmt, ResetsTakeBackWhatTheyShould) {
  SimulatedDrive drive = ready_drive();
  enable(drive);
  must(drive, 0x1017, 0, 100);
  must(drive, 0x6087, 0, 7);
  must(drive, 0x6040, 0, 0);
  say(drive, "000#82 01");  // communication alone
  EXPECT_EQ(value(drive, 0x1017), 0);
  EXPECT_EQ(value(drive, 0x6087), 7);
  EXPECT_EQ(pass(drive, kSecond), Said{});
  say(drive, "000#81 01");
  EXPECT_EQ(value(drive, 0x6087), 1000);
  EXPECT_EQ(drive.state(), DriveState::kNotReady);
  drive.elapse(0);
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(Nmt, StoredSettingsStartNoMotor) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x6060, 0, kCyclicTorque);
  must(drive, 0x6071, 0, 300);
  must(drive, 0x60B2, 0, 300);
  must(drive, 0x6040, 0, 7);
  must(drive, 0x5F00, 0, 1);
  must(drive, 0x5F00, 0, 0);
  must(drive, 0x1010, 1, 0x65766173);
  say(drive, "000#81 01");
  drive.elapse(0);
  EXPECT_EQ(value(drive, 0x6060), kCyclicTorque);
  enable(drive);
  EXPECT_EQ(drive.current(), 0);
  EXPECT_EQ(value(drive, 0x1003), 0);
}

TEST(Nmt, LeavingOperationalStopsTheMotor) {
  for (const std::string command : {"000#02 01", "000#80 01", "000#82 01"}) {
    SimulatedDrive drive = ready_drive();
    say(drive, "000#01 01");
    enable(drive);
    must(drive, 0x6071, 0, 300);
    say(drive, command);
    EXPECT_EQ(drive.current(), 0) << command;
    EXPECT_EQ(drive.state(), DriveState::kFaultReaction) << command;
  }
}

TEST(Heartbeat, IsProducedInTime) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1017, 0, 10);
  EXPECT_EQ(pass(drive, 9 * kMillisecond), Said{});
  EXPECT_EQ(pass(drive, kMillisecond), Said{"701#7F"});
  say(drive, "000#02 01");
  EXPECT_EQ(pass(drive, 10 * kMillisecond), Said{"701#04"});
  say(drive, "000#01 01");
  EXPECT_EQ(pass(drive, 10 * kMillisecond), Said{"701#05"});
  must(drive, 0x1017, 0, 0);
  EXPECT_EQ(pass(drive, kSecond), Said{});
}

TEST(Heartbeat, LostOneIsToldAndStopsTheMotor) {
  for (const auto& [option, state] : {std::pair{0, DriveState::kOperationEnabled},
                                      {1, DriveState::kFault},
                                      {2, DriveState::kSwitchOnDisabled},
                                      {3, DriveState::kSwitchOnDisabled}}) {
    SimulatedDrive drive = ready_drive();
    must(drive, 0x1016, 1, 0x7F << 16 | 100);
    must(drive, 0x6007, 0, option);
    enable(drive);
    say(drive, "000#01 01");
    must(drive, 0x6071, 0, 300);
    EXPECT_EQ(pass(drive, kSecond), Said{}) << "it waits for a first one";
    say(drive, "77F#05");
    EXPECT_EQ(pass(drive, 99 * kMillisecond), Said{});
    say(drive, "77F#05");
    EXPECT_EQ(pass(drive, 99 * kMillisecond), Said{});
    const Said lost = pass(drive, kMillisecond);
    ASSERT_FALSE(lost.empty());
    EXPECT_EQ(lost[0], "081#30 81 11 00 00 00 00 00");
    drive.elapse(0);
    EXPECT_EQ(drive.state(), state);
    EXPECT_EQ(drive.torque(), option == 0 ? 300 : 0);
    EXPECT_EQ(drive.nmt(), NmtState::kPreOperational);  // 0x1029:1 = 0
    heard(drive);
    const Said again = say(drive, "77F#05");
    EXPECT_EQ(again.size(), option == 1 ? 0 : 1);  // a fault waits for its reset
  }
}

// CiA 301, 0x1029: 0 leaves the operational state only, 2 stops a node in any.
TEST(Heartbeat, ErrorBehaviourIsConfigured) {
  constexpr auto kReady = NmtState::kPreOperational, kRuns = NmtState::kOperational;
  const auto lost = [](const char* begin, int behaviour) {
    SimulatedDrive drive = ready_drive();
    must(drive, 0x1016, 2, 5 << 16 | 50);
    must(drive, 0x1029, 1, behaviour);
    say(drive, begin);
    say(drive, "705#05");
    drive.elapse(50 * kMillisecond);
    return drive.nmt();
  };
  for (const auto& [behaviour, running, ready] : {std::tuple{0, kReady, kReady},
                                                  {1, kRuns, kReady},
                                                  {2, NmtState::kStopped, NmtState::kStopped}}) {
    EXPECT_EQ(lost("000#01 01", behaviour), running);
    EXPECT_EQ(lost("000#80 01", behaviour), ready);
  }
}

TEST(Heartbeat, OneNodeIsWatchedOnce) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1016, 1, 5 << 16 | 50);
  EXPECT_EQ(drive.write(0x1016, 2, 5 << 16 | 60), Abort::kIncompatible);
  EXPECT_EQ(drive.write(0x1016, 2, 128 << 16 | 60), Abort::kValue);
  must(drive, 0x1016, 1, 5 << 16 | 60);
}

TEST(Heartbeat, NoResetWaitsForALostMaster) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1016, 1, 0x7F << 16 | 100);
  enable(drive);
  say(drive, "77F#05");
  drive.elapse(100 * kMillisecond);
  drive.elapse(0);
  ASSERT_EQ(drive.state(), DriveState::kFault);
  must(drive, 0x6040, 0, 0);
  must(drive, 0x6040, 0, 0x80);
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(heard(drive), (Said{"081#30 81 11 00 00 00 00 00", "081#00 00 00 00 00 00 00 00"}));
}

TEST(Silence, OfTheProcessDataStopsTheMotor) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1400, 5, 10);
  say(drive, "000#01 01");
  enable(drive);
  must(drive, 0x6071, 0, 300);
  say(drive, "201#0F 00");
  drive.elapse(9 * kMillisecond);
  EXPECT_EQ(drive.torque(), 300);
  drive.elapse(kMillisecond);
  EXPECT_EQ(drive.torque(), 0);
  EXPECT_EQ(value(drive, 0x603F), 0x8250);
}

TEST(Silence, OfTheSyncStopsTheMotor) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1006, 0, 1000);
  say(drive, "000#01 01");
  enable(drive);
  must(drive, 0x6071, 0, 300);
  say(drive, "080#");
  drive.elapse(kSyncPatience * kMillisecond - 1);
  EXPECT_EQ(drive.torque(), 300);
  drive.elapse(1);
  EXPECT_EQ(drive.torque(), 0);
  EXPECT_EQ(value(drive, 0x603F), 0x8700);
}

struct OnRequest {
  Condition condition;
  std::string emcy;
  std::int64_t code;
  std::int64_t latched;
};

TEST(Faults, OnRequestAreToldLatchedAndReset) {
  const std::vector<OnRequest> all{
      {Condition::kOverVoltage, "081#10 32 05 20 00 00 00 00", 0x3210, 0x20},
      {Condition::kEncoderLost, "081#05 73 21 80 00 00 00 00", 0x7305, 0x80},
      {Condition::kOverTemperature, "081#10 42 09 08 00 00 00 00", 0x4210, 0x08},
  };
  for (const OnRequest& one : all) {
    SimulatedDrive drive = ready_drive();
    enable(drive);
    must(drive, 0x6071, 0, 300);
    must(drive, 0x5F00, 0, static_cast<std::int64_t>(one.condition));  // as over the bus
    EXPECT_EQ(heard(drive), Said{one.emcy});
    EXPECT_EQ(drive.current(), 0);
    EXPECT_EQ(value(drive, 0x603F), one.code);
    EXPECT_EQ(value(drive, 0x2183), one.latched);
    EXPECT_NE(value(drive, 0x1002) & (1 << 22), 0);
    drive.elapse(0);
    must(drive, 0x2183, 0, one.latched);
    EXPECT_EQ(value(drive, 0x2183), one.latched) << "its cause is still there";
    must(drive, 0x5F00, 0, 0);
    EXPECT_EQ(value(drive, 0x2183), one.latched) << "latched";
    must(drive, 0x2183, 0, one.latched);
    EXPECT_EQ(value(drive, 0x2183), 0);
    must(drive, 0x6040, 0, 0);
    must(drive, 0x6040, 0, 0x80);
    EXPECT_EQ(heard(drive), Said{"081#00 00 00 00 00 00 00 00"});
    EXPECT_EQ(value(drive, 0x603F), 0);
    EXPECT_EQ(value(drive, 0x1001), 0);
    EXPECT_EQ(value(drive, 0x1003, 1) & 0xFFFF, one.code);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  }
}

TEST(Faults, HistoryKeepsTheLastEightNewestFirst) {
  SimulatedDrive drive = ready_drive();
  for (int i = 0; i < 10; ++i) {
    must(drive, 0x5F00, 0, i % 2 == 0 ? 1 : 4);
    must(drive, 0x5F00, 0, 0);
    drive.elapse(0);
    must(drive, 0x6040, 0, 0);
    must(drive, 0x6040, 0, 0x80);
  }
  const Said answers = heard(drive);
  ASSERT_EQ(answers.size(), 20);
  EXPECT_EQ(answers[18], "081#10 42 09 08 00 00 00 00");
  EXPECT_EQ(answers[19], "081#00 00 00 00 00 00 00 00");
  EXPECT_EQ(value(drive, 0x1003), 8);
  EXPECT_EQ(value(drive, 0x1003, 1) & 0xFFFF, 0x4210);
  EXPECT_EQ(value(drive, 0x1003, 2) & 0xFFFF, 0x3210);
  must(drive, 0x1003, 0, 0);
  EXPECT_EQ(say(drive, "601#40 03 10 01 00 00 00 00"), Said{"581#80 03 10 01 24 00 00 08"});
}

TEST(Faults, EmcyInhibitTimeSpacesThem) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1015, 0, 100);  // 10 ms
  must(drive, 0x5F00, 0, 1);
  must(drive, 0x5F00, 0, 3);
  EXPECT_EQ(heard(drive), Said{"081#10 32 05 20 00 00 00 00"});
  EXPECT_EQ(pass(drive, 9 * kMillisecond), Said{});
  EXPECT_EQ(pass(drive, kMillisecond), Said{"081#05 73 25 A0 00 00 00 00"});
}

TEST(Faults, EmcyMayBeOff) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1014, 0, kInvalid | 0x81);
  must(drive, 0x5F00, 0, 1);
  EXPECT_EQ(heard(drive), Said{});
}

TEST(Faults, LostEncoderFreezesThePosition) {
  SimulatedDrive drive = ready_drive();
  drive.set_position(100);
  must(drive, 0x5F00, 0, 2);
  drive.set_position(200);
  EXPECT_EQ(value(drive, 0x6064), 100);
}

TEST(Faults, SilentNodeHearsAndSaysNothing) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x1017, 0, 10);
  drive.set_condition(Condition::kSilent, true);
  EXPECT_EQ(say(drive, "601#40 00 10 00 00 00 00 00"), Said{});
  EXPECT_EQ(say(drive, "000#01 01"), Said{});
  EXPECT_EQ(pass(drive, kSecond), Said{});
  EXPECT_EQ(drive.nmt(), NmtState::kPreOperational);
  drive.set_condition(Condition::kSilent, false);
  EXPECT_EQ(pass(drive, 10 * kMillisecond), Said{"701#7F"});
}

TEST(Position, WrapsAsA32BitCounter) {
  SimulatedDrive drive = ready_drive();
  drive.set_position((std::int64_t{1} << 31) + 5);
  EXPECT_EQ(value(drive, 0x6064), -(std::int64_t{1} << 31) + 5);
  drive.set_position(-(std::int64_t{1} << 31) - 1);
  EXPECT_EQ(value(drive, 0x6064), (std::int64_t{1} << 31) - 1);
}

TEST(Position, GivesTheVelocity) {
  SimulatedDrive drive = ready_drive();
  drive.elapse(kMillisecond);
  drive.set_position(-3);
  EXPECT_EQ(value(drive, 0x606C), -30'000);  // 0.1 counts/s
}

TEST(Torque, ProfileRampsAndCyclicDoesNot) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x6087, 0, 2000);
  enable(drive, kProfileTorque);
  must(drive, 0x6071, 0, 100);
  EXPECT_EQ(value(drive, 0x6041) & statusword::kTargetReached, 0);
  drive.elapse(10 * kMillisecond);
  EXPECT_EQ(value(drive, 0x6074), 20);
  drive.elapse(40 * kMillisecond);
  EXPECT_EQ(value(drive, 0x6077), 100);
  EXPECT_NE(value(drive, 0x6041) & statusword::kTargetReached, 0);
  must(drive, 0x6040, 0, 0x010F);  // halt
  drive.elapse(10 * kMillisecond);
  EXPECT_EQ(drive.torque(), 80);
  must(drive, 0x6060, 0, kCyclicTorque);
  EXPECT_EQ(value(drive, 0x6061), kCyclicTorque);
  EXPECT_EQ(drive.torque(), 100);
  must(drive, 0x60B2, 0, -30);
  EXPECT_EQ(drive.torque(), 70);
  EXPECT_NE(value(drive, 0x6041) & statusword::kFollowsCommand, 0);
}

TEST(Torque, IsLimitedByTorqueAndCurrent) {
  SimulatedDrive drive = ready_drive();
  EXPECT_EQ(value(drive, 0x6072), 4000);  // four times rated
  enable(drive);
  must(drive, 0x6071, 0, -5000);
  EXPECT_EQ(drive.torque(), -4000);
  EXPECT_NE(value(drive, 0x6041) & statusword::kInternalLimit, 0);
  must(drive, 0x6073, 0, 1500);
  EXPECT_EQ(drive.torque(), -1500);
  must(drive, 0x6072, 0, 700);
  EXPECT_EQ(drive.torque(), -700);
  must(drive, 0x6071, 0, 700);
  EXPECT_EQ(value(drive, 0x6041) & statusword::kInternalLimit, 0);
}

TEST(Torque, OverloadFallsBackToRated) {
  SimulatedDrive drive = ready_drive({.peak_time = 0.5});
  enable(drive);
  must(drive, 0x6071, 0, 2000);  // spends 3 a second of a budget of 7.5
  for (int i = 0; i < 249; ++i) drive.elapse(10 * kMillisecond);
  EXPECT_EQ(drive.torque(), 2000);
  EXPECT_EQ(value(drive, 0x2183), 0);
  drive.elapse(20 * kMillisecond);
  EXPECT_EQ(drive.torque(), 1000);
  EXPECT_EQ(value(drive, 0x2183), 0x400);
  EXPECT_NE(value(drive, 0x6041) & statusword::kWarning, 0);
  EXPECT_NE(value(drive, 0x6041) & statusword::kInternalLimit, 0);
  EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
  must(drive, 0x6071, 0, 0);  // fills it up again, 1 a second
  drive.elapse(7 * kSecond);
  must(drive, 0x6071, 0, 2000);
  EXPECT_EQ(drive.torque(), 1000);
  must(drive, 0x6071, 0, 0);
  drive.elapse(kSecond);
  must(drive, 0x6071, 0, 2000);
  EXPECT_EQ(drive.torque(), 2000);
  EXPECT_EQ(value(drive, 0x6041) & statusword::kWarning, 0);
}

TEST(Torque, OverloadStaysLatchedUntilCleared) {
  SimulatedDrive drive = ready_drive({.peak_time = 0.1});
  enable(drive);
  must(drive, 0x6071, 0, 4000);
  for (int i = 0; i < 11; ++i) drive.elapse(10 * kMillisecond);
  must(drive, 0x2183, 0, 0x400);
  EXPECT_EQ(value(drive, 0x2183), 0x400) << "it still holds";
  must(drive, 0x6071, 0, 0);
  for (int i = 0; i < 20; ++i) drive.elapse(100 * kMillisecond);
  EXPECT_EQ(value(drive, 0x6041) & statusword::kWarning, 0);
  EXPECT_EQ(value(drive, 0x2183), 0x400);
  must(drive, 0x2183, 0, 0x400);
  EXPECT_EQ(value(drive, 0x2183), 0);
  EXPECT_EQ(heard(drive), Said{}) << "a limit is no emergency";
}

TEST(Torque, OverloadIsAFaultWhereTheMaskSaysSo) {
  SimulatedDrive drive = ready_drive({.peak_time = 0.1});
  must(drive, 0x2182, 0, 0x400);
  enable(drive);
  must(drive, 0x6071, 0, 4000);
  for (int i = 0; i < 11; ++i) drive.elapse(10 * kMillisecond);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(value(drive, 0x603F), 0x2350);
  EXPECT_EQ(drive.current(), 0);
  must(drive, 0x6040, 0, 0);
  must(drive, 0x6040, 0, 0x80);
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(value(drive, 0x2183), 0);
}

TEST(Torque, ScaleIsThatOfTheMotorData) {
  SimulatedDrive drive = ready_drive();
  EXPECT_EQ(value(drive, 0x6075), 985);  // mA
  EXPECT_EQ(value(drive, 0x6076), 53);   // mN m
  must(drive, 0x6410, 14, 10600);        // under the former index
  EXPECT_EQ(value(drive, 0x2383, 14), 10600);
  EXPECT_EQ(value(drive, 0x6076), 106);
  enable(drive);
  must(drive, 0x6071, 0, 500);
  EXPECT_NEAR(drive.current(), copley_current(500, 10600, 5380), 1e-15);
}

/// Of an object that the data sheet of another drive has in part, only that part is written and counted.
TEST(SimulatedDriveEds, CountsTheSubIndicesItShows) {
  const std::vector<SheetEntry> sheet{{.index = 0x1018, .sub = 0}, {.index = 0x1018, .sub = 1}};
  const std::string text = eds(SimulatedDrive({.sheet = sheet}).objects());
  EXPECT_NE(text.find("ObjectType=0x9\nSubNumber=2\n"), std::string::npos);
  EXPECT_EQ(text.find("[1018sub2]"), std::string::npos);
}

/// What another drive's data sheet has and the table has not is served by SDO, and written.
TEST(SimulatedDriveEds, HasTheObjectsThatOnlyTheDataSheetHas) {
  const std::vector<SheetEntry> sheet{
      {.index = 0x1018, .sub = 0},
      {.index = 0x1018, .sub = 7, .access = Access::kRo, .high = 0xFFFFFFFF},
      {.index = 0x3000, .width = 2, .low = -5, .high = 32767, .initial = -2, .has_initial = true},
      {.index = 0x3001, .sub = 0, .access = Access::kRo, .width = 1, .high = 255},
      {.index = 0x3001, .sub = 0xA, .mappable = true, .width = 0, .text = "a name"},
      {.index = 0x6071, .mappable = false, .width = 2}};
  const std::string text = eds(SimulatedDrive({.sheet = sheet}).objects());
  const auto has = [&](const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  };
  has("[ManufacturerObjects]\nSupportedObjects=2\n1=0x3000\n2=0x3001\n");
  has("[1018]\nParameterName=Identity object\nObjectType=0x9\nSubNumber=2\n");
  has("[1018sub7]\nParameterName=Sub-index 7\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\n"
      "PDOMapping=0\n");
  has("[3000]\nParameterName=Object 0x3000\nObjectType=0x7\nDataType=0x0003\nAccessType=rw\n"
      "DefaultValue=-2\nPDOMapping=0\nLowLimit=-5\n");
  has("[3001]\nParameterName=Object 0x3001\nObjectType=0x9\nSubNumber=2\n");
  has("[3001subA]\nParameterName=Sub-index 10\nObjectType=0x7\nDataType=0x0009\nAccessType=rw\n"
      "DefaultValue=a name\nPDOMapping=1\n");
  const std::size_t torque = text.find("[6071]");
  ASSERT_NE(torque, std::string::npos);
  EXPECT_NE(text.find("PDOMapping=0", torque), std::string::npos) << "the drive refuses to map it";
}

/// What a data sheet lets be written, and what the drive makes of it.
TEST(SimulatedDriveEds, AWriteChangesNoOtherObject) {
  std::vector<SheetEntry> sheet{{.index = 0x1008, .width = 0}, {.index = 0x6403, .width = 0}};
  for (const std::uint8_t sub : std::initializer_list<std::uint8_t>{0, 1, 8}) {
    sheet.push_back({.index = 0x1003, .sub = sub, .access = Access::kRw});
    sheet.push_back({.index = 0x1016, .sub = sub, .access = Access::kRw});
  }
  sheet.push_back({.index = 0x1005, .access = Access::kRw});
  SimulatedDrive drive({.sheet = sheet});
  EXPECT_EQ(drive.write(0x1003, 8, 0), Abort::kNone);
  EXPECT_EQ(value(drive, 0x1005), 0x80);
  EXPECT_EQ(drive.write(0x1016, 0, 4), Abort::kReadOnly);  // as many as the drive has
  const std::array<std::uint8_t, 3> name{'a', 'b', 'c'};
  EXPECT_EQ(drive.download(0x1008, 0, name), Abort::kReadOnly);
  std::array<std::uint8_t, 64> out{};
  std::size_t size = 0;
  EXPECT_EQ(drive.upload(0x6403, 0, out, size), Abort::kNone);
  EXPECT_EQ(size, 0U);
}

TEST(SimulatedDriveEds, HasADefaultOfTheDataSheetWhereTheTableHasTheNode) {
  const std::vector<SheetEntry> sheet{
      {.index = 0x1014, .access = Access::kRw, .initial = 0x81, .has_initial = true},
      {.index = 0x1018, .sub = 4, .access = Access::kRo, .initial = 0x1234, .has_initial = true}};
  const SimulatedDrive drive({.sheet = sheet});
  EXPECT_EQ(value(drive, 0x1018, 4), 0x1234);
  const std::string text = eds(drive.objects());
  EXPECT_NE(text.find("DefaultValue=0x1234\n"), std::string::npos) << text;
  EXPECT_NE(text.find("DefaultValue=$NODEID+0x80\n"), std::string::npos) << text;
}

TEST(SimulatedDriveEds, SaysThatTheDriveAnswersLss) {
  EXPECT_NE(eds(SimulatedDrive().objects()).find("LSS_Supported=1\n"), std::string::npos);
}

/// A motor whose peak torque is that many times its continuous one lets the drive give all it can, the way it is asked to.
TEST(Torque, OfAMotorWithAnyPeakHasTheSignOfItsTarget) {
  std::vector<SheetEntry> sheet;
  for (const std::uint8_t sub : std::initializer_list<std::uint8_t>{13, 14}) {
    sheet.push_back({.index = 0x2383, .sub = sub, .access = Access::kRw});
  }
  for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x6040, 0x6060, 0x6071}) {
    sheet.push_back({.index = index, .access = Access::kRw});
  }
  SimulatedDrive drive({.sheet = sheet});
  drive.elapse(0);
  must(drive, 0x2383, 13, 4294967295);
  must(drive, 0x2383, 14, 1);
  must(drive, 0x6060, 0, kCyclicTorque);
  for (const int word : {6, 7, 15}) must(drive, 0x6040, 0, word);
  must(drive, 0x6071, 0, 300);
  EXPECT_EQ(drive.torque(), 300);
}

TEST(Encoder, ACountFarFromTheLastOneIsAsFastAsADriveCanSay) {
  SimulatedDrive drive;
  drive.set_position(std::numeric_limits<std::int64_t>::max());
  drive.elapse(kMillisecond);
  drive.set_position(std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(value(drive, 0x606C), std::numeric_limits<std::int32_t>::min());
}

}  // namespace
}  // namespace ebac::can::simulated_drive_test
