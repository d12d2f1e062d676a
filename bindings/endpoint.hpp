#pragma once

#include <stdexcept>
#include <string>

#include "ebac/sensor/udp.hpp"

namespace ebac::python {

/// An address and a port, given as a number of Python's; `what` names it where it is none.
inline sensor::Endpoint endpoint(const char* what, const std::string& host, int port) {
  if (port < 0 || port > 65535) {
    throw std::invalid_argument(std::string(what) + ": port = " + std::to_string(port) +
                                ": must lie in [0, 65535]");
  }
  return sensor::resolve(host, static_cast<std::uint16_t>(port), what);
}

}  // namespace ebac::python
