#pragma once

#include <array>
#include <cstdint>

#include "ebac/canopen/cob_id.hpp"
#include "ebac/canopen/torque_watch.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/model/motor.hpp"

namespace ebac::can {

/// Settings of the drives on the bus of a loop, one per axis.
struct CanopenSetup {
  int axes = 1;
  std::array<NodeId, kMaxAxes> node{1, 2, 3};  // of each axis, in their order
  /// Of each axis, 1 or -1: what a positive current and a rising count are turned by, so that both
  /// have the signs of sample.hpp.
  std::array<int, kMaxAxes> motor_sign{1, 1, 1};
  std::array<int, kMaxAxes> encoder_sign{1, 1, 1};
  /// What each drive shows (0x6064) with the handle at its zero [counts]; any number will do, as the
  /// difference is taken in the 32 bits of the drive.
  std::array<std::int32_t, kMaxAxes> encoder_zero{};
  Motor motor{};                 // for eq. (1)
  Drive drive{};                 // for its limit
  int silent_ticks = 3;          // samples
  int enable_ticks = 1000;       // samples
  int torque_ticks = 10;         // samples
  int torque_tolerance = 100;    // thousandths of the rated torque
  double heartbeat_timeout = 0;  // s
  int own_node = 0;
  double heartbeat_period = 0.01;  // s
  double guard_period = 0;         // s

  static constexpr auto fields() {
    using F = Field<CanopenSetup>;
    return std::array{
        F{"axes", &CanopenSetup::axes, "1", "drives on the bus, one per axis", 1, kMaxAxes},
        F{"silent_ticks", &CanopenSetup::silent_ticks, "samples",
          "ticks in a row without process data, in either direction, that are a fault", 1, 1000},
        F{"enable_ticks", &CanopenSetup::enable_ticks, "samples",
          "ticks the drives may take to reach operation enabled", 1, 1e6},
        F{"torque_ticks", &CanopenSetup::torque_ticks, "samples",
          "lag a drive's torque may have behind the commanded one, and how long it may differ from "
          "it before that is a fault",
          1, TorqueWatch::kMostTicks},
        F{"torque_tolerance", &CanopenSetup::torque_tolerance, "1",
          "difference that is none, in thousandths of the rated torque, on top of a tenth of the "
          "commanded torque",
          1, 32767},
        F{"heartbeat_timeout", &CanopenSetup::heartbeat_timeout, "s",
          "longest time between two heartbeats of a node; 0 watches none", 0, 3 * 60},
        F{"own_node", &CanopenSetup::own_node, "1",
          "node number under which the loop sends a heartbeat of its own; 0 sends none", 0,
          kLastNode},
        F{"heartbeat_period", &CanopenSetup::heartbeat_period, "s",
          "time between two of the loop's own heartbeats", 1e-3, 60},
        F{"guard_period", &CanopenSetup::guard_period, "s",
          "time between two requests of node guarding to each node; 0 sends none", 0, 60},
    };
  }
};

/// Throws std::invalid_argument for a field, a node or a sign out of range, and for a node given twice, to the loop itself
/// among them.
void check_setup(const CanopenSetup& setup);

}  // namespace ebac::can
