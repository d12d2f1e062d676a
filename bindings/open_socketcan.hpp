#pragma once

#include <string>

#include "ebac/can/socketcan.hpp"
#include "from_system.hpp"

namespace ebac::python {

/// Throws Python's OSError where it cannot be opened.
inline can::SocketCan open_socketcan(const std::string& interface,
                                     const can::SocketCanOptions& options) {
  return from_system([&] { return can::SocketCan(interface, options); });
}

}  // namespace ebac::python
