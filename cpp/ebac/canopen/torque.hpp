#pragma once

#include <array>
#include <cstdint>

#include "ebac/can/cob_id.hpp"

namespace ebac::can {

/// A number written into the object dictionary of a drive.
struct ObjectWrite {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::int64_t value = 0;
};

/// What makes a drive follow a torque at every SYNC and answer each with `pdo_plan`'s data, in the
/// order in which it must be written (CiA 301, 7.5.2.36). `most`: thousandths of the rated torque.
constexpr std::array<ObjectWrite, 18> torque_settings(NodeId node, int most) EBAC_RT {
  constexpr std::int64_t kOff = 1LL << 31;
  constexpr std::int64_t kAlone = 1LL << 30;  // never asked for by a remote frame
  constexpr std::int64_t kEverySync = 1;
  constexpr std::int64_t kCyclicTorqueMode = 10;
  constexpr std::int64_t kNoCurrentLimit = 0xFFFF;
  return {{
      {0x6060, 0, kCyclicTorqueMode},
      {0x6072, 0, most},
      {0x6073, 0, kNoCurrentLimit},  // the torque is limited, not both
      {0x1400, 1, kOff | rpdo(1, node)},
      {0x1400, 2, kEverySync},
      {0x1600, 0, 0},
      {0x1600, 1, 0x60400010},  // controlword
      {0x1600, 2, 0x60710010},  // target torque
      {0x1600, 0, 2},
      {0x1400, 1, rpdo(1, node)},
      {0x1800, 1, kOff | kAlone | tpdo(1, node)},
      {0x1800, 2, kEverySync},
      {0x1A00, 0, 0},
      {0x1A00, 1, 0x60410010},  // statusword
      {0x1A00, 2, 0x60640020},  // position
      {0x1A00, 3, 0x60770010},  // actual torque
      {0x1A00, 0, 3},
      {0x1800, 1, kAlone | tpdo(1, node)},
  }};
}

}  // namespace ebac::can
