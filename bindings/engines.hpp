#pragma once

#include <pybind11/pybind11.h>

namespace ebac::python {

/// Engines of others and the bridge to them: part of the worlds.
void bind_engines(pybind11::module_& m);

}  // namespace ebac::python
