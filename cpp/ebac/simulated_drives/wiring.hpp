#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ebac/core/realtime.hpp"
#include "ebac/simulated_drives/simulated_drive.hpp"

namespace ebac::can {

/// How the drive of each axis is set on its bus and connected to the device.
struct Wiring {
  std::array<NodeId, kMaxAxes> node{1, 2, 3};
  std::array<std::span<const SheetEntry>, kMaxAxes> sheet{};  // read by the constructor only
  std::array<std::int32_t, kMaxAxes> zero{};   // counts, what it shows at the device's zero
  std::array<int, kMaxAxes> motor{1, 1, 1};    // -1: its current pushes the other way
  std::array<int, kMaxAxes> encoder{1, 1, 1};  // -1: it counts the other way
};

}  // namespace ebac::can
