#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <system_error>

#include "ebac/can/socketcan.hpp"

namespace ebac::python {

/// Python's OSError with the number and the remedy, where it cannot be opened.
inline can::SocketCan open_socketcan(const std::string& interface,
                                     const can::SocketCanOptions& options) {
  try {
    return can::SocketCan(interface, options);
  } catch (const std::system_error& error) {
    const pybind11::tuple what = pybind11::make_tuple(error.code().value(), error.what());
    PyErr_SetObject(PyExc_OSError, what.ptr());
    throw pybind11::error_already_set();
  }
}

}  // namespace ebac::python
