#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"

namespace ebac::can {

/// What a row tells of one drive on the bus. Counts only grow.
struct BusRow {
  int statusword = 0;
  int controlword = 0;
  int target_permille = 0;     // thousandths of the rated torque
  int actual_permille = 0;     // thousandths of the rated torque
  int emergency = 0;           // error code, CiA 301 and 402
  int heartbeat = -1;          // NMT state
  std::int64_t age = 0;        // samples
  std::int64_t missing = 0;    // ticks
  std::int64_t late = 0;       // frames
  std::int64_t duplicate = 0;  // frames
  std::int64_t malformed = 0;  // frames
  std::int64_t foreign = 0;    // frames
  std::int64_t refused = 0;    // frames

  static constexpr auto fields() {
    using F = Field<BusRow>;
    return std::array{
        F{"statusword", &BusRow::statusword, "1", "last statusword of the drive (0x6041)"},
        F{"controlword", &BusRow::controlword, "1", "controlword sent in this tick (0x6040)"},
        F{"target_permille", &BusRow::target_permille, "1",
          "torque sent in this tick, in thousandths of the rated torque (0x6071)"},
        F{"actual_permille", &BusRow::actual_permille, "1",
          "torque the drive says it gave, in thousandths of the rated torque (0x6077)"},
        F{"emergency", &BusRow::emergency, "1", "error code of the last emergency; 0 for none yet"},
        F{"heartbeat", &BusRow::heartbeat, "1",
          "NMT state in the last heartbeat: 0 boot-up, 4 stopped, 5 operational, 127 "
          "pre-operational; -1 for none yet"},
        F{"age", &BusRow::age, "samples", "age of the drive's process data; 0 when of this tick"},
        F{"missing", &BusRow::missing, "1", "ticks without process data of the drive, so far"},
        F{"late", &BusRow::late, "1", "answers that came after their tick, so far"},
        F{"duplicate", &BusRow::duplicate, "1", "answers to a tick that had one, so far"},
        F{"malformed", &BusRow::malformed, "1", "frames of the drive of a wrong length, so far"},
        F{"foreign", &BusRow::foreign, "1",
          "frames that belong to no drive of this device, so far; one count for the whole bus"},
        F{"refused", &BusRow::refused, "1",
          "frames to the drive, SYNC among them, that the bus did not take, so far"},
    };
  }
};

}  // namespace ebac::can
