#pragma once

#include <pybind11/pybind11.h>

namespace ebac::python {

/// A channel to an engine in another process, and its other end.
void bind_engine_process(pybind11::module_& m);

}  // namespace ebac::python
