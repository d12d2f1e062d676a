// PDOs of a drive: remapping step by step, and when which type sends and takes effect.
#include "transcript.hpp"

namespace ebac::can::pdo_test {
namespace {

constexpr std::int64_t kTpdo1 = kNoRemote | 0x181;
constexpr std::int64_t kTorqueAndWord = 0x60710010;

/// Operational; what it says at first is heard.
SimulatedDrive operational() {
  SimulatedDrive drive = ready_drive();
  say(drive, "000#01 01");
  return drive;
}

TEST(Pdo, ComesWithStatuswordOnChange) {
  SimulatedDrive drive = ready_drive();
  EXPECT_EQ(say(drive, "000#01 01"), Said{"181#50 02"});
  EXPECT_EQ(say(drive, "201#06 00"), Said{"181#31 02"});
  EXPECT_EQ(say(drive, "201#06 00"), Said{});
  EXPECT_EQ(say(drive, "301#06 00 0A"), Said{});  // prepared, and off
}

TEST(Pdo, IsRemappedByTheStandardProcedure) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(drive, {
                             {"601#23 00 18 01 81 01 00 C0", "581#60 00 18 01 00 00 00 00"},
                             {"601#2F 00 18 02 01 00 00 00", "581#60 00 18 02 00 00 00 00"},
                             {"601#2F 00 1A 00 00 00 00 00", "581#60 00 1A 00 00 00 00 00"},
                             {"601#23 00 1A 01 10 00 41 60", "581#60 00 1A 01 00 00 00 00"},
                             {"601#23 00 1A 02 20 00 64 60", "581#60 00 1A 02 00 00 00 00"},
                             {"601#23 00 1A 03 10 00 77 60", "581#60 00 1A 03 00 00 00 00"},
                             {"601#2F 00 1A 00 03 00 00 00", "581#60 00 1A 00 00 00 00 00"},
                             {"601#23 00 18 01 81 01 00 40", "581#60 00 18 01 00 00 00 00"},
                             {"000#01 01", ""},
                         });
  drive.set_position(-2);
  EXPECT_EQ(say(drive, "080#"), Said{"181#50 02 FE FF FF FF 00 00"});
}

TEST(Pdo, EveryWrongStepIsRefused) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive,
      {
          {"601#2F 00 1A 00 00 00 00 00", "581#80 00 1A 00 00 00 01 06"},  // while it is valid
          {"601#23 00 1A 01 10 00 41 60", "581#80 00 1A 01 00 00 01 06"},
          {"601#2B 00 18 03 0A 00 00 00", "581#80 00 18 03 22 00 00 08"},  // inhibit time
          {"601#23 00 18 01 81 02 00 40", "581#80 00 18 01 30 00 09 06"},  // another identifier
          {"601#23 00 18 01 81 01 00 00", "581#80 00 18 01 30 00 09 06"},  // remote frames
          {"601#23 00 18 01 81 01 00 E0", "581#80 00 18 01 30 00 09 06"},  // 29-bit identifier
          {"601#2F 00 18 02 F1 00 00 00", "581#80 00 18 02 30 00 09 06"},  // type 241
          {"601#2F 00 18 02 FD 00 00 00", "581#80 00 18 02 30 00 09 06"},  // type 253
          {"601#23 00 18 01 81 01 00 C0", "581#60 00 18 01 00 00 00 00"},  // off
          {"601#23 00 18 01 01 06 00 40", "581#80 00 18 01 30 00 09 06"},  // the SDO server's
          {"601#23 00 18 01 00 00 00 40", "581#80 00 18 01 30 00 09 06"},  // NMT's
          {"601#23 00 1A 02 20 00 64 60", "581#80 00 1A 02 00 00 01 06"},  // sub 0 is not 0
          {"601#2F 00 1A 00 09 00 00 00", "581#80 00 1A 00 42 00 04 06"},  // nine entries
          {"601#2F 00 1A 00 00 00 00 00", "581#60 00 1A 00 00 00 00 00"},
          {"601#23 00 1A 01 20 00 00 20", "581#80 00 1A 01 00 00 02 06"},  // no such object
          {"601#23 00 1A 01 20 05 18 10", "581#80 00 1A 01 11 00 09 06"},  // no such sub-index
          {"601#23 00 1A 01 20 00 00 10", "581#80 00 1A 01 41 00 04 06"},  // not mappable
          {"601#23 00 1A 01 08 00 41 60", "581#80 00 1A 01 41 00 04 06"},  // 8 bits of 16
          {"601#23 00 1A 01 08 00 05 00", "581#80 00 1A 01 00 00 02 06"},  // a dummy is for RPDOs
          {"601#23 00 1A 01 20 00 64 60", "581#60 00 1A 01 00 00 00 00"},
          {"601#23 00 1A 02 20 00 6C 60", "581#60 00 1A 02 00 00 00 00"},
          {"601#23 00 1A 03 10 00 41 60", "581#60 00 1A 03 00 00 00 00"},
          {"601#2F 00 1A 00 03 00 00 00", "581#80 00 1A 00 42 00 04 06"},  // 80 bits
          {"601#2F 00 1A 00 04 00 00 00", "581#80 00 1A 00 00 00 02 06"},  // the fourth is empty
          {"601#2F 00 1A 00 02 00 00 00", "581#60 00 1A 00 00 00 00 00"},
          {"601#23 01 16 01 10 00 41 60", "581#80 01 16 01 00 00 01 06"},  // RPDO 2: sub 0 is 2
          {"601#2F 01 16 00 00 00 00 00", "581#60 01 16 00 00 00 00 00"},
          {"601#23 01 16 01 10 00 41 60",
           "581#80 01 16 01 41 00 04 06"},  // read only, not for RPDOs
          {"601#23 01 16 01 10 00 06 00", "581#60 01 16 01 00 00 00 00"},  // two bytes dropped
      });
}

TEST(Pdo, DummiesSkipBytes) {
  SimulatedDrive drive = ready_drive();
  remap(drive, 0x1401, 0x301, 255, {0x00060010, kTorqueAndWord});
  say(drive, "000#01 01");
  say(drive, "301#FF FF 0A 00");
  EXPECT_EQ(value(drive, 0x6071), 10);
}

TEST(Pdo, SynchronousDataWaitForTheSync) {
  for (const std::uint8_t type : std::array<std::uint8_t, 3>{0, 1, 240}) {
    SimulatedDrive drive = operational();
    remap(drive, 0x1401, 0x301, type, {kTorqueAndWord});
    say(drive, "301#0A 00");
    say(drive, "301#14 00");
    EXPECT_EQ(value(drive, 0x6071), 0);
    say(drive, "080#");
    EXPECT_EQ(value(drive, 0x6071), 20);  // the last of them
    must(drive, 0x6071, 0, 5);
    say(drive, "080#");
    EXPECT_EQ(value(drive, 0x6071), 5);  // once
  }
}

TEST(Pdo, AsynchronousDataActAtOnce) {
  for (const std::uint8_t type : std::array<std::uint8_t, 2>{254, 255}) {
    SimulatedDrive drive = operational();
    remap(drive, 0x1401, 0x301, type, {kTorqueAndWord});
    say(drive, "301#F6 FF 99");  // longer than mapped: the first bytes count
    EXPECT_EQ(value(drive, 0x6071), -10);
  }
}

TEST(Pdo, IsSentEveryNthSync) {
  SimulatedDrive drive = operational();
  remap(drive, 0x1800, kTpdo1, 3, {0x60410010});
  for (int sync = 1; sync <= 9; ++sync) {
    EXPECT_EQ(say(drive, "080#").size(), sync % 3 == 0 ? 1 : 0) << sync;
  }
}

TEST(Pdo, Type0IsSentWithTheSyncAfterAChange) {
  SimulatedDrive drive = operational();
  remap(drive, 0x1800, kTpdo1, 0, {0x60640020});
  EXPECT_EQ(say(drive, "080#"), Said{"181#00 00 00 00"});
  EXPECT_EQ(say(drive, "080#"), Said{});
  drive.set_position(1);
  EXPECT_EQ(pass(drive, kMillisecond), Said{});
  EXPECT_EQ(say(drive, "080#"), Said{"181#01 00 00 00"});
}

TEST(Pdo, InputsAreThoseBeforeTheSyncTakesEffect) {
  SimulatedDrive drive = ready_drive();
  remap(drive, 0x1400, 0x201, 1, {kTorqueAndWord});
  remap(drive, 0x1800, kTpdo1, 1, {0x60770010});
  enable(drive);
  say(drive, "000#01 01");
  say(drive, "201#2C 01");
  EXPECT_EQ(say(drive, "080#"), Said{"181#00 00"});
  EXPECT_EQ(drive.torque(), 300);
  EXPECT_EQ(say(drive, "080#"), Said{"181#2C 01"});  // what acted between them
}

TEST(Pdo, InhibitTimeHoldsBackAndSendsTheLatest) {
  SimulatedDrive drive = operational();
  must(drive, 0x1800, 1, kTpdo1 | kInvalid);
  must(drive, 0x1800, 3, 50);  // 5 ms
  remap(drive, 0x1800, kTpdo1, 255, {0x60640020});
  EXPECT_EQ(pass(drive, 0), Said{"181#00 00 00 00"});
  drive.set_position(1);
  EXPECT_EQ(pass(drive, 2 * kMillisecond), Said{});
  drive.set_position(2);
  EXPECT_EQ(pass(drive, 2 * kMillisecond), Said{});
  EXPECT_EQ(pass(drive, kMillisecond), Said{"181#02 00 00 00"});
  EXPECT_EQ(pass(drive, 10 * kMillisecond), Said{});
}

TEST(Pdo, EventTimerSendsWithoutAChange) {
  SimulatedDrive drive = operational();
  must(drive, 0x1800, 5, 10);
  EXPECT_EQ(pass(drive, 0), Said{"181#50 02"});
  EXPECT_EQ(pass(drive, 9 * kMillisecond), Said{});
  EXPECT_EQ(pass(drive, kMillisecond), Said{"181#50 02"});
  EXPECT_EQ(pass(drive, 10 * kMillisecond), Said{"181#50 02"});
}

TEST(Pdo, RemoteFramesAreNotAnswered) {
  SimulatedDrive drive = operational();
  drive.receive({.id = 0x181, .remote = true});
  drive.receive({.id = 0x201, .size = 2, .remote = true});
  EXPECT_EQ(heard(drive), Said{});
}

TEST(Pdo, ShortOneIsAnErrorUntilAGoodOneComes) {
  SimulatedDrive drive = operational();
  EXPECT_EQ(say(drive, "201#06"), Said{"081#10 82 11 00 00 00 00 00"});
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(say(drive, "201#06"), Said{});  // reported once
  EXPECT_EQ(value(drive, 0x1003), 1);
  EXPECT_EQ(value(drive, 0x1003, 1), 0x8210);
  EXPECT_EQ(say(drive, "201#06 00"), (Said{"081#00 00 00 00 00 00 00 00", "181#31 02"}));
  EXPECT_EQ(drive.state(), DriveState::kReady);
}

TEST(Pdo, NothingWithoutOperational) {
  SimulatedDrive drive = ready_drive();
  EXPECT_EQ(say(drive, "201#06 00"), Said{});
  EXPECT_EQ(say(drive, "080#"), Said{});
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  say(drive, "000#01 00");
  say(drive, "000#80 00");
  EXPECT_EQ(say(drive, "201#06 00"), Said{});
  EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(Pdo, SyncIdentifierMayMove) {
  SimulatedDrive drive = ready_drive();
  remap(drive, 0x1800, kTpdo1, 1, {0x60410010});
  must(drive, 0x1005, 0, 0x90);
  say(drive, "000#01 01");
  EXPECT_EQ(say(drive, "080#"), Said{});
  EXPECT_EQ(say(drive, "090#").size(), 1);
}

/// The data sheet of a drive may lack what its PDO 1 carries from the start on.
TEST(Tpdo, SendsZerosForAnObjectThatTheDriveDoesNotHave) {
  const std::vector<SheetEntry> sheet{{.index = 0x6040, .access = Access::kRw}};
  SimulatedDrive drive({.sheet = sheet});
  heard(drive);
  EXPECT_EQ(say(drive, "000#01 01"), Said{"181#00 00"});
}

}  // namespace
}  // namespace ebac::can::pdo_test
