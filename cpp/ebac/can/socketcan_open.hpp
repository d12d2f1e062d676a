#pragma once

#include <string>

#include "ebac/can/socketcan.hpp"

/// The steps of opening a raw CAN socket. None of them waits.
namespace ebac::can {

/// A bound, non-blocking socket with its options set. Throws std::system_error.
int open_raw(const std::string& interface, const SocketCanOptions& options);

/// Binds to the interface of that name, which may be a new one: 0, or errno.
int bind_raw(int socket, const std::string& interface) noexcept;

/// Whether the interface is there and up: 0, ENETDOWN, ENODEV.
int look_up(int socket, const std::string& interface) noexcept;

}  // namespace ebac::can
