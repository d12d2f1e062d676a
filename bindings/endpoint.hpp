#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "ebac/sensor/udp.hpp"
#include "others_run.hpp"

namespace ebac::python {

/// The address of a host, without the interpreter's lock: a name server may take seconds to answer.
inline sensor::Endpoint resolved(const std::string& host, std::uint16_t port,
                                 const std::string& what = "sensor") {
  const OthersRun others_run;
  return sensor::resolve(host, port, what);
}

/// An address and a port, given as a number of Python's; `what` names it where it is none.
inline sensor::Endpoint endpoint(const char* what, const std::string& host, int port) {
  if (port < 0 || port > 65535) {
    throw std::invalid_argument(std::string(what) + ": port = " + std::to_string(port) +
                                ": must lie in [0, 65535]");
  }
  return resolved(host, static_cast<std::uint16_t>(port), what);
}

}  // namespace ebac::python
