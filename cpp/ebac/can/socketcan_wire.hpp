#pragma once

#include <linux/can.h>

#include "ebac/can/bus.hpp"

/// Between frames and what the kernel's sockets carry.
namespace ebac::can {

can_frame to_wire(const Frame& out) noexcept;
Frame from_wire(const can_frame& in) noexcept;

/// How the bus stands after an error frame of the controller (linux/can/error.h).
BusState after_error(const Frame& error, BusState before) noexcept;

}  // namespace ebac::can
