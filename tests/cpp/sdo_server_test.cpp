// What the SDO server of a drive answers, byte by byte.
#include "transcript.hpp"

namespace ebac::can::sdo_server_test {
namespace {

TEST(Crc16, IsThatOfCia301) {
  const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16(digits), 0x31C3);  // CRC-16/XMODEM, the check value of its catalogue
  EXPECT_EQ(crc16({}), 0);
}

TEST(Sdo, ExpeditedUploadOfEveryLength) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive,
      {
          {"601#40 00 10 00 00 00 00 00", "581#43 00 10 00 92 01 02 00"},  // u32 device type
          {"601#40 41 60 00 00 00 00 00", "581#4B 41 60 00 50 02 00 00"},  // u16 statusword
          {"601#40 01 10 00 00 00 00 00", "581#4F 01 10 00 00 00 00 00"},  // u8 error register
          {"601#40 0A 10 00 00 00 00 00", "581#4F 0A 10 00 31 00 00 00"},  // a string of one byte
          {"601#40 83 23 0C 00 00 00 00", "581#43 83 23 0C 04 15 00 00"},  // 5380 1e-5 N m/A
          {"601#40 83 23 0E 00 00 00 00", "581#43 83 23 0E B4 14 00 00"},  // 5300 1e-5 N m
      });
}

TEST(Sdo, SegmentedUpload) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive,
      {
          {"601#40 08 10 00 00 00 00 00", "581#41 08 10 00 14 00 00 00"},  // 20 bytes
          {"601#60 00 00 00 00 00 00 00", "581#00 65 62 61 63 20 73 69"},  // "ebac si"
          {"601#70 00 00 00 00 00 00 00", "581#10 6D 75 6C 61 74 65 64"},  // "mulated"
          {"601#60 00 00 00 00 00 00 00", "581#03 20 64 72 69 76 65 00"},  // " drive"
          {"601#70 00 00 00 00 00 00 00", "581#80 08 10 00 01 00 04 05"},  // there is no more
      });
}

TEST(Sdo, EmptyStringIsSegmented) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(drive, {
                             {"601#40 03 64 00 00 00 00 00", "581#41 03 64 00 00 00 00 00"},
                             {"601#60 00 00 00 00 00 00 00", "581#0F 00 00 00 00 00 00 00"},
                         });
}

TEST(Sdo, ExpeditedDownload) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive,
      {
          {"601#2B 17 10 00 F4 01 00 00", "581#60 17 10 00 00 00 00 00"},  // heartbeat 500 ms
          {"601#40 17 10 00 00 00 00 00", "581#4B 17 10 00 F4 01 00 00"},
          {"601#2B 71 60 00 9C FF 00 00", "581#60 71 60 00 00 00 00 00"},  // -100
          {"601#40 71 60 00 00 00 00 00", "581#4B 71 60 00 9C FF 00 00"},
          {"601#22 71 60 00 07 00 AA AA", "581#60 71 60 00 00 00 00 00"},  // length not told
          {"601#40 71 60 00 00 00 00 00", "581#4B 71 60 00 07 00 00 00"},
      });
  EXPECT_EQ(value(drive, 0x6071), 7);
}

TEST(Sdo, SegmentedDownload) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive, {
                 {"601#21 04 64 00 09 00 00 00", "581#60 04 64 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},  // "maxon R"
                 {"601#1D 45 00 00 00 00 00 00", "581#80 04 64 00 13 00 07 06"},  // a byte short
                 {"601#21 04 64 00 09 00 00 00", "581#60 04 64 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},
                 {"601#1B 45 33 00 00 00 00 00", "581#30 00 00 00 00 00 00 00"},  // "E3"
             });
}

TEST(Sdo, SegmentedDownloadOfNineBytesIsReadBack) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive, {
                 {"601#20 04 64 00 00 00 00 00", "581#60 04 64 00 00 00 00 00"},  // length not told
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},
                 {"601#1B 45 33 00 00 00 00 00", "581#30 00 00 00 00 00 00 00"},
                 {"601#40 04 64 00 00 00 00 00", "581#41 04 64 00 09 00 00 00"},
                 {"601#60 00 00 00 00 00 00 00", "581#00 6D 61 78 6F 6E 20 52"},
                 {"601#70 00 00 00 00 00 00 00", "581#1B 45 33 00 00 00 00 00"},
             });
}

TEST(Sdo, AbortCodesWhereTheyBelong) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive,
      {
          {"601#40 00 20 00 00 00 00 00", "581#80 00 20 00 00 00 02 06"},  // no object
          {"601#40 18 10 05 00 00 00 00", "581#80 18 10 05 11 00 09 06"},  // no sub-index
          {"601#40 00 5F 00 00 00 00 00", "581#80 00 5F 00 01 00 01 06"},  // write only
          {"601#2B 41 60 00 00 00 00 00", "581#80 41 60 00 02 00 01 06"},  // read only
          {"601#23 00 10 00 00 00 00 00", "581#80 00 10 00 02 00 01 06"},  // constant
          {"601#23 17 10 00 00 00 00 00", "581#80 17 10 00 10 00 07 06"},  // 4 bytes for 2
          {"601#2F 17 10 00 00 00 00 00", "581#80 17 10 00 10 00 07 06"},  // 1 byte for 2
          {"601#21 17 10 00 05 00 00 00", "581#80 17 10 00 10 00 07 06"},  // 5 bytes announced
          {"601#21 04 64 00 29 00 00 00", "581#80 04 64 00 12 00 07 06"},  // 41 bytes for 40
          {"601#21 04 64 00 FF FF FF FF", "581#80 04 64 00 12 00 07 06"},
          {"601#2F 60 60 00 01 00 00 00", "581#80 60 60 00 30 00 09 06"},  // mode 1 is not offered
          {"601#2B 07 60 00 04 00 00 00", "581#80 07 60 00 31 00 09 06"},  // above the high limit
          {"601#2B 07 60 00 FF FF 00 00", "581#80 07 60 00 32 00 09 06"},  // below the low limit
          {"601#23 10 10 01 00 00 00 00", "581#80 10 10 01 20 00 00 08"},  // not "save"
          {"601#40 03 10 01 00 00 00 00", "581#80 03 10 01 24 00 00 08"},  // no error yet
          {"601#2F 03 10 00 01 00 00 00", "581#80 03 10 00 30 00 09 06"},
          {"601#C2 00 10 00 04 00 00 00", "581#80 00 10 00 02 00 01 06"},  // block download
          {"601#A4 00 10 00 80 00 00 00", "581#80 00 10 00 02 00 04 05"},  // 128 segments
          {"601#E0 00 10 00 00 00 00 00", "581#80 00 10 00 01 00 04 05"},  // nothing anyone knows
      });
}

TEST(Sdo, RefusesInTheWrongState) {
  SimulatedDrive drive = ready_drive();
  enable(drive);
  expect_dialogue(drive,
                  {
                      {"601#23 83 23 0E 00 10 00 00",
                       "581#80 83 23 0E 22 00 00 08"},  // the scale of the torque
                      {"601#23 10 10 01 73 61 76 65", "581#80 10 10 01 22 00 00 08"},  // "save"
                      {"601#2B 00 23 00 00 00 00 00", "581#80 00 23 00 22 00 00 08"},
                  });
  must(drive, 0x6040, 0, 0);
  expect_dialogue(drive, {
                             {"601#23 83 23 0E 00 10 00 00", "581#60 83 23 0E 00 00 00 00"},
                             {"601#23 10 10 01 73 61 76 65", "581#60 10 10 01 00 00 00 00"},
                         });
}

TEST(Sdo, WrongToggleEndsTheTransfer) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(drive, {
                             {"601#40 08 10 00 00 00 00 00", "581#41 08 10 00 14 00 00 00"},
                             {"601#70 00 00 00 00 00 00 00", "581#80 08 10 00 00 00 03 05"},
                             {"601#60 00 00 00 00 00 00 00", "581#80 08 10 00 01 00 04 05"},
                             {"601#21 04 64 00 09 00 00 00", "581#60 04 64 00 00 00 00 00"},
                             {"601#10 6D 61 78 6F 6E 20 52", "581#80 04 64 00 00 00 03 05"},
                         });
}

TEST(Sdo, ClientMayAbortAndStartAnew) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive, {
                 {"601#40 08 10 00 00 00 00 00", "581#41 08 10 00 14 00 00 00"},
                 {"601#80 08 10 00 00 00 04 05", ""},
                 {"601#60 00 00 00 00 00 00 00", "581#80 08 10 00 01 00 04 05"},
                 {"601#21 04 64 00 09 00 00 00", "581#60 04 64 00 00 00 00 00"},  // half-finished,
                 {"601#40 00 10 00 00 00 00 00", "581#43 00 10 00 92 01 02 00"},  // then another
                 {"601#00 6D 61 78 6F 6E 20 52", "581#80 00 10 00 01 00 04 05"},
             });
}

TEST(Sdo, MoreSegmentsThanAnnounced) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(
      drive, {
                 {"601#21 04 64 00 05 00 00 00", "581#60 04 64 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#80 04 64 00 12 00 07 06"},
                 {"601#20 04 64 00 00 00 00 00", "581#60 04 64 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},
                 {"601#10 6D 61 78 6F 6E 20 52", "581#30 00 00 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},
                 {"601#10 6D 61 78 6F 6E 20 52", "581#30 00 00 00 00 00 00 00"},
                 {"601#00 6D 61 78 6F 6E 20 52", "581#20 00 00 00 00 00 00 00"},
                 {"601#11 6D 61 78 6F 6E 20 52", "581#80 04 64 00 12 00 07 06"},  // 42 bytes for 40
             });
  EXPECT_EQ(say(drive, "601#40 04 64 00 00 00 00 00"), Said{"581#41 04 64 00 00 00 00 00"});
}

TEST(Sdo, SilentWhereTheProtocolAsksForIt) {
  SimulatedDrive drive = ready_drive();
  expect_dialogue(drive, {
                             {"602#40 00 10 00 00 00 00 00", ""},  // another node
                             {"601#40 00 10 00", ""},              // not eight bytes
                             {"581#40 00 10 00 00 00 00 00", ""},  // an answer
                             {"000#02 01", ""},                    // stopped
                             {"601#40 00 10 00 00 00 00 00", ""},
                         });
}

TEST(Sdo, StoresAndRestores) {
  SimulatedDrive drive = ready_drive();
  must(drive, 0x6087, 0, 123);
  must(drive, 0x1010, 1, 0x65766173);
  must(drive, 0x6087, 0, 456);
  EXPECT_EQ(value(drive, 0x1010, 1), 1);
  EXPECT_EQ(say(drive, "000#81 01"), Said{"701#00"});
  EXPECT_EQ(value(drive, 0x6087), 123);
  must(drive, 0x1011, 1, 0x64616F6C);
  EXPECT_EQ(value(drive, 0x6087), 123);  // until the next reset
  say(drive, "000#81 00");
  EXPECT_EQ(value(drive, 0x6087), 1000);
}

}  // namespace
}  // namespace ebac::can::sdo_server_test
