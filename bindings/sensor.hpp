#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "ebac/sensor/mounting.hpp"
#include "ebac/sensor/udp.hpp"
#include "endpoint.hpp"
#include "fields.hpp"
#include "from_system.hpp"

namespace ebac::python {

/// A port of the network; 0 only where any free one will do.
inline std::uint16_t checked_port(int port, int least) {
  if (port < least || port > 65535) {
    throw std::invalid_argument(range_message("sensor", "port", port, "1", least, 65535));
  }
  return static_cast<std::uint16_t>(port);
}

inline sensor::Mounting checked_mounting(const std::array<double, 9>& rotation, int sign) {
  const sensor::Mounting mounting{.rotation = rotation, .sign = sign};
  sensor::check_mounting(mounting);
  return mounting;
}

}  // namespace ebac::python
