#include "ebac/sim/linear_loop.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "bind.hpp"

namespace ebac::python {

namespace py = pybind11;

void bind_linear_loop(py::module_& m) {
  py::class_<LinearLoop>(m, "LinearLoop",
                         "One axis in a virtual spring and damper without a law, linear and exact.")
      .def(py::init<const Setup&>(), py::arg("setup"))
      .def_static("covers", &LinearLoop::covers, py::arg("device"),
                  "Whether a device is linear deep in a wall, friction and counts apart.")
      .def("eigenvalues", &LinearLoop::eigenvalues, py::arg("stiffness"), py::arg("damping"),
           "Eigenvalues from tick to tick; stiffness [N/m], damping [N s/m] of the wall.")
      .def("spectral_radius", &LinearLoop::spectral_radius, py::arg("stiffness"),
           py::arg("damping"), "Largest modulus of an eigenvalue; below one, everything decays.")
      .def("stiffness_limit", &LinearLoop::stiffness_limit, py::arg("damping"),
           py::call_guard<py::gil_scoped_release>(),
           "Largest stiffness [N/m] up to which everything decays; 0 for none.");
}

}  // namespace ebac::python
