#pragma once

#include <linux/can.h>

#include <string>
#include <vector>

#include "ebac/can/bus.hpp"
#include "ebac/can/socketcan.hpp"

/// The steps of opening a raw CAN socket. None of them waits.
namespace ebac::can {

/// The filters in the kernel's format; without any, one filter that passes every frame.
std::vector<can_filter> to_wire(const std::vector<CanFilter>& filters);

/// A bound, non-blocking socket with its options set. Throws std::system_error.
int open_raw(const std::string& interface, const SocketCanOptions& options);

/// Binds to the interface of this name, which may be a new one; returns 0 or errno. Sets the
/// filters too, as the kernel drops the filters of an interface that disappears.
int bind_raw(int socket, const std::string& interface,
             const std::vector<can_filter>& filters) noexcept;

/// Whether the interface exists and is up: 0, ENETDOWN, ENODEV.
int look_up(int socket, const std::string& interface) noexcept;

/// Clears the error that the kernel keeps for the next call.
void forget_error(int socket) noexcept;

can_frame to_wire(const Frame& out) noexcept;
Frame from_wire(const can_frame& in) noexcept;

/// How the bus stands after an error frame of the controller (linux/can/error.h).
BusState after_error(const Frame& error, BusState before) noexcept;

}  // namespace ebac::can
