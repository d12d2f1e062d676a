#include "bind.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "The C++ core of ebac. Use it through the package `ebac`.";
  ebac::python::bind_leaving();
  ebac::python::bind_core(m);
  ebac::python::bind_realtime(m);
  ebac::python::bind_kinematics(m);
  ebac::python::bind_devices(m);
  ebac::python::bind_hands(m);
  ebac::python::bind_worlds(m);
  ebac::python::bind_environment(m);
  ebac::python::bind_simulation(m);
  ebac::python::bind_replay(m);
  ebac::python::bind_sensor(m);
  ebac::python::bind_sensor_emulator(m);
  ebac::python::bind_drives(m);
  ebac::python::bind_sweeps(m);
  ebac::python::bind_linear_loop(m);
  ebac::python::bind_identify(m);
  ebac::python::bind_can_plan(m);
  ebac::python::bind_python_law(m);
  ebac::python::bind_can(m);
  ebac::python::bind_node_server(m);
  ebac::python::bind_limits(m);
  ebac::python::bind_faults(m);
  ebac::python::bind_controllers(m);
  ebac::python::bind_gastroscope(m);
  ebac::python::bind_running(m);
  ebac::python::bind_teleop(m);
  // A wrong call is refused by pybind11 before any code of ours runs; the words for it are Python's.
  pybind11::module_::import("ebac._util.wrong_calls").attr("wrap_members")(m);
}
