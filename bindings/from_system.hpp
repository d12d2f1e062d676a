#pragma once

#include <pybind11/pybind11.h>

#include <system_error>

namespace ebac::python {

namespace py = pybind11;

/// Python's OSError with the number and the remedy, where the system does not give something.
template <class Make>
auto from_system(Make make) {
  try {
    return make();
  } catch (const std::system_error& error) {
    const py::tuple what = py::make_tuple(error.code().value(), error.what());
    PyErr_SetObject(PyExc_OSError, what.ptr());
    throw py::error_already_set();
  }
}

}  // namespace ebac::python
