#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <system_error>

#include "ebac/sensor/mounting.hpp"
#include "ebac/sensor/udp.hpp"
#include "fields.hpp"

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

/// Python's OSError with the number and the remedy, where the network does not give it.
template <class Make>
auto from_network(Make make) {
  try {
    return make();
  } catch (const std::system_error& error) {
    const py::tuple what = py::make_tuple(error.code().value(), error.what());
    PyErr_SetObject(PyExc_OSError, what.ptr());
    throw py::error_already_set();
  }
}

}  // namespace ebac::python
