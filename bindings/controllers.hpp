#pragma once

#include <pybind11/pybind11.h>

#include "ebac/control/law_type.hpp"

namespace ebac::python {

/// Makes a law of your own a Python class of `module`, as those of `ebac`: parameters, state,
/// design, stepping, simulation, replay, sweeps and real time.
template <Controller Law>
void bind_controller(pybind11::module_& module, const char* name) {
  const pybind11::capsule type(static_cast<const void*>(&law_type<Law>()));
  pybind11::module_::import("ebac._core").attr("_bind_law")(module, name, type);
}

}  // namespace ebac::python
