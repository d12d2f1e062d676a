#include "ebac/can/node_server.hpp"

#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <string>

#include "bind.hpp"
#include "ebac/can/loopback_bus.hpp"
#include "ebac/can/socketcan.hpp"
#include "joystick.hpp"
#include "open_socketcan.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

/// Drives wait for a loop that was held up; more is lost, and counted.
constexpr std::size_t kFrames = 4096;

using OptionalForce = Shared<sensor::SharedForce>;
using OptionalTarget = Shared<rt::SharedHandTarget>;

template <can::WaitingBus Bus>
using JoystickServer = can::NodeServer<Bus, PlantOfDrives>;

py::module_ at_exit() { return py::module_::import("atexit"); }

/// What they are on whichever bus. The interpreter stops those that are forgotten before it ends.
template <can::WaitingBus Bus>
void add_work(py::class_<JoystickServer<Bus>>& cls) {
  using Work = JoystickServer<Bus>;
  const auto start = [](const py::object& self, rt::Mode mode, const rt::Options& realtime) {
    self.cast<Work&>().start(mode, realtime);
    at_exit().attr("register")(self.attr("stop"));
    return self;
  };
  const auto stop = [](const py::object& self) {
    auto& work = self.cast<Work&>();
    {
      const OthersRun others_run;
      work.stop();
    }
    at_exit().attr("unregister")(self.attr("stop"));
  };
  cls.def("start", start, py::arg_v("mode", rt::Mode::kOff, "RealTimeMode.OFF"),
          py::arg("realtime") = rt::Options{}, "Start the drives on the bus; possible once.")
      .def("stop", stop, "Take the drives off the bus for good.")
      .def("__enter__", [start](const py::object& self) { return start(self, rt::Mode::kOff, {}); })
      .def(
          "__exit__",
          [stop](const py::object& self, const py::object&, const py::object&, const py::object&) {
            stop(self);
          },
          py::arg("kind") = py::none(), py::arg("error") = py::none(),
          py::arg("traceback") = py::none())
      .def_property_readonly(
          "grants", &Work::grants,
          "Resources that its thread requested and was granted; empty before the start.")
      .def_property_readonly("state", &Work::state, "State of the bus.")
      .def_property_readonly("counts", &Work::counts, "Frame counts of their end of the bus.");
}

}  // namespace

void bind_node_server(py::module_& m) {
  const py::class_<DrivenMachine, std::shared_ptr<DrivenMachine>> driven(m, "_DrivenMachine");
  using OnLoopback = JoystickServer<can::LoopbackBus>;
  using OnSocketCan = JoystickServer<can::SocketCan>;
  py::class_<OnLoopback> inside(
      m, "LoopbackJoystick",
      "Simulated drives of a joystick on a bus inside this process, in real time, in a thread of\n"
      "its own that never waits for Python; their plant moves for `longest_step` [s] at most "
      "between\n"
      "two SYNCs. A context manager.");
  inside.def(
      py::init([](can::LoopbackHub& hub, const Setup& setup, const DriveWiring& wiring,
                  double peak_time, const OptionalForce& force, bool wait_for_power,
                  const OptionalTarget& aim, double longest_step,
                  const std::optional<std::shared_ptr<DrivenMachine>>& load) {
        PlantOfDrives joystick = make_joystick(setup, wiring, peak_time, force, wait_for_power, aim,
                                               longest_step, load.value_or(nullptr));
        return std::make_unique<OnLoopback>(hub.open({.frames = kFrames}), std::move(joystick));
      }),
      py::arg("hub"), py::arg("setup"), py::kw_only(),
      py::arg_v("wiring", DriveWiring{}, "DriveWiring()"), py::arg("peak_time") = 2.0,
      py::arg("force") = py::none(), py::arg("wait_for_power") = false, py::arg("aim") = py::none(),
      py::arg("longest_step") = std::numeric_limits<double>::infinity(),
      py::arg("load") = py::none());
  add_work(inside);
  py::class_<OnSocketCan> outside(
      m, "SocketCanJoystick",
      "Simulated drives of a joystick on a CAN interface of the Linux kernel, in real time, in a\n"
      "thread of its own that never waits for Python. A context manager.");
  outside.def(py::init([](const std::string& interface, const Setup& setup,
                          const DriveWiring& wiring, double peak_time, const OptionalForce& force,
                          bool wait_for_power, const OptionalTarget& aim) {
                PlantOfDrives joystick =
                    make_joystick(setup, wiring, peak_time, force, wait_for_power, aim);
                return std::make_unique<OnSocketCan>(open_socketcan(interface, {}),
                                                     std::move(joystick));
              }),
              py::arg("interface"), py::arg("setup"), py::kw_only(),
              py::arg_v("wiring", DriveWiring{}, "DriveWiring()"), py::arg("peak_time") = 2.0,
              py::arg("force") = py::none(), py::arg("wait_for_power") = false,
              py::arg("aim") = py::none());
  add_work(outside);
}

}  // namespace ebac::python
