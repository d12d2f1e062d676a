#include "bind.hpp"

PYBIND11_MODULE(_core, m, pybind11::mod_gil_not_used()) {
  m.doc() = "The C++ core of ebac. Use it through the package `ebac`.";
  ebac::python::bind_core(m);
  ebac::python::bind_model(m);
  ebac::python::bind_simulation(m);
  ebac::python::bind_sweeps(m);
  ebac::python::bind_linear_loop(m);
  ebac::python::bind_controllers(m);
  ebac::python::bind_python_law(m);
}
