#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <string>

#include "ebac/control/law_type.hpp"
#include "ebac/headers.hpp"

namespace ebac::python {

/// What a module of laws and the core must be compiled with alike, since they share values in memory.
inline std::string compiled_with() {
  return std::string(kHeaders) + ", Eigen aligned to " + std::to_string(EIGEN_MAX_ALIGN_BYTES) +
         " bytes";
}

/// Makes a law of your own a Python class of `module`, as those of `ebac`: parameters, state,
/// design, stepping, simulation, replay, sweeps and real time. Raises ImportError where `module` is
/// compiled with other headers than the core that runs.
template <Controller Law>
void bind_controller(pybind11::module_& module, const char* name) {
  const pybind11::capsule type(static_cast<const void*>(&law_type<Law>()));
  pybind11::module_::import("ebac._core").attr("_bind_law")(module, name, compiled_with(), type);
}

}  // namespace ebac::python
