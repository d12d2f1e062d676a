#include "ebac/sim/linear_loop.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace py = pybind11;

void bind_linear_loop(py::module_& m) {
  py::class_<LinearLoop>(m, "LinearLoop",
                         "One axis in a virtual spring and damper without a law, linear and exact.")
      .def(py::init<const Setup&>(), py::arg("setup"))
      .def_static("covers", &LinearLoop::covers, py::arg("device"),
                  "Return whether a device is linear deep in a wall, apart from friction and "
                  "encoder counts.")
      .def("eigenvalues", &LinearLoop::eigenvalues, py::arg("stiffness"), py::arg("damping"),
           "Return the eigenvalues of one tick, for a wall of stiffness [N/m] and damping [N s/m].")
      .def("spectral_radius", &LinearLoop::spectral_radius, py::arg("stiffness"),
           py::arg("damping"),
           "Return the largest modulus of an eigenvalue; the loop is stable below 1.")
      .def("stiffness_limit", &LinearLoop::stiffness_limit, py::arg("damping"),
           py::call_guard<OthersRun>(), "Return the largest stable stiffness [N/m]; 0 for none.");
}

}  // namespace ebac::python
