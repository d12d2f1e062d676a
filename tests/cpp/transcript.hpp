#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "ebac/simulated_drives/simulated_drive.hpp"

/// What is said on a bus, written as candump writes it: "601#40 00 10 00 00 00 00 00".
namespace ebac::can {

inline Frame parse(const std::string& text) {
  const std::size_t hash = text.find('#');
  Frame made{.id = static_cast<std::uint32_t>(std::stoul(text.substr(0, hash), nullptr, 16))};
  for (std::size_t at = hash + 1; at + 1 < text.size(); at += 3) {
    made.data.at(made.size++) =
        static_cast<std::uint8_t>(std::stoul(text.substr(at, 2), nullptr, 16));
  }
  return made;
}

inline std::string show(const Frame& frame) {
  std::array<char, 8> piece{};
  std::snprintf(piece.data(), piece.size(), "%03X#", frame.id);
  std::string text(piece.data());
  for (std::size_t i = 0; i < frame.size; ++i) {
    std::snprintf(piece.data(), piece.size(), i == 0 ? "%02X" : " %02X", frame.data.at(i));
    text += piece.data();
  }
  return text;
}

using Said = std::vector<std::string>;

inline Said heard(SimulatedDrive& drive) {
  Said all;
  Frame frame;
  while (drive.take(frame)) all.push_back(show(frame));
  return all;
}

/// Everything the drive says to one frame.
inline Said say(SimulatedDrive& drive, const std::string& text) {
  drive.receive(parse(text));
  return heard(drive);
}

inline Said pass(SimulatedDrive& drive, std::int64_t ns) {
  drive.elapse(ns);
  return heard(drive);
}

/// A question and its answer; empty where there is none.
struct Line {
  std::string tx;
  std::string rx;
};

inline void expect_dialogue(SimulatedDrive& drive, const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    const Said expected = line.rx.empty() ? Said{} : Said{line.rx};
    EXPECT_EQ(say(drive, line.tx), expected) << line.tx;
  }
}

/// Node 1, booted, its boot-up message heard, its self-test done.
inline SimulatedDrive ready_drive(const DriveSettings& settings = {}) {
  SimulatedDrive drive(settings);
  drive.elapse(0);
  heard(drive);
  return drive;
}

inline void must(SimulatedDrive& drive, std::uint16_t index, std::uint8_t sub, std::int64_t value) {
  ASSERT_EQ(drive.write(index, sub, value), Abort::kNone)
      << std::hex << index << ":" << int{sub} << " = " << value;
}

inline std::int64_t value(const SimulatedDrive& drive, std::uint16_t index, std::uint8_t sub = 0) {
  return drive.objects()[kDriveTable.slot(index, sub)];
}

inline void enable(SimulatedDrive& drive, std::int8_t mode = kCyclicTorque) {
  must(drive, 0x6060, 0, mode);
  for (const std::int64_t word : {6, 7, 15}) must(drive, 0x6040, 0, word);
  ASSERT_EQ(drive.state(), DriveState::kOperationEnabled);
}

/// Remaps a PDO by the standard procedure; `cob_id` as it shall be in the end.
inline void remap(SimulatedDrive& drive, std::uint16_t communication, std::int64_t cob_id,
                  std::uint8_t type, const std::vector<std::int64_t>& entries) {
  const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
  must(drive, communication, 1, cob_id | kInvalid);
  must(drive, communication, 2, type);
  must(drive, mapping, 0, 0);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    must(drive, mapping, static_cast<std::uint8_t>(i + 1), entries[i]);
  }
  must(drive, mapping, 0, static_cast<std::int64_t>(entries.size()));
  must(drive, communication, 1, cob_id);
}

}  // namespace ebac::can
