#pragma once

#include <pybind11/pybind11.h>

/// The parts of the module, in the order in which they need each other.
namespace ebac::python {

void bind_leaving();
void bind_core(pybind11::module_& m);
void bind_realtime(pybind11::module_& m);
void bind_kinematics(pybind11::module_& m);
void bind_devices(pybind11::module_& m);
void bind_hands(pybind11::module_& m);
void bind_worlds(pybind11::module_& m);
void bind_environment(pybind11::module_& m);
void bind_simulation(pybind11::module_& m);
void bind_replay(pybind11::module_& m);
void bind_sweeps(pybind11::module_& m);
void bind_controllers(pybind11::module_& m);
void bind_sensor(pybind11::module_& m);
void bind_sensor_emulator(pybind11::module_& m);
void bind_drives(pybind11::module_& m);
void bind_node_server(pybind11::module_& m);
void bind_gastroscope(pybind11::module_& m);
void bind_linear_loop(pybind11::module_& m);
void bind_identify(pybind11::module_& m);
void bind_can_plan(pybind11::module_& m);
void bind_python_law(pybind11::module_& m);
void bind_can(pybind11::module_& m);
void bind_limits(pybind11::module_& m);
void bind_faults(pybind11::module_& m);
void bind_running(pybind11::module_& m);
void bind_teleop(pybind11::module_& m);

}  // namespace ebac::python
