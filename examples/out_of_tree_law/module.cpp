#include <ebac/python/controllers.hpp>

#include "damped.hpp"
#include "tank.hpp"

PYBIND11_MODULE(my_laws, m) {
  pybind11::options options;
  options.disable_function_signatures();
  pybind11::module_::import("ebac._core");  // Port, Timing and Setup are Python classes there
  ebac::python::bind_controller<Damped>(m, "Damped");
  ebac::python::bind_controller<Tank>(m, "Tank");
}
