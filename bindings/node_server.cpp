#include "ebac/can/served.hpp"

#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "bind.hpp"
#include "ebac/can/loopback_bus.hpp"
#include "ebac/can/socketcan.hpp"
#include "joystick.hpp"
#include "open_socketcan.hpp"

namespace ebac::python {

namespace {

/// Drives wait for a loop that was held up; more is lost, and counted.
constexpr std::size_t kFrames = 4096;

using Felt = Shared<sensor::ForceCell>;
using Aim = Shared<rt::AimCell>;

template <can::WaitingBus Bus>
using ServedJoystick = can::Served<Bus, PlantOfDrives>;

py::module_ at_exit() { return py::module_::import("atexit"); }

/// What they are on whichever bus. The interpreter stops those that are forgotten before it ends.
template <can::WaitingBus Bus>
void add_work(py::class_<ServedJoystick<Bus>>& cls) {
  using Work = ServedJoystick<Bus>;
  const auto start = [](const py::object& self, rt::Mode mode, const rt::Options& realtime) {
    self.cast<Work&>().start(mode, realtime);
    at_exit().attr("register")(self.attr("stop"));
    return self;
  };
  const auto stop = [](const py::object& self) {
    auto& work = self.cast<Work&>();
    {
      const py::gil_scoped_release others_run;
      work.stop();
    }
    at_exit().attr("unregister")(self.attr("stop"));
  };
  cls.def("start", start, py::arg_v("mode", rt::Mode::kOff, "RealTimeMode.OFF"),
          py::arg("realtime") = rt::Options{}, "Puts them on the bus, once in a life.")
      .def("stop", stop, "Takes them off for good.")
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
          "What its thread asked of the system, and got; nothing before it is started.")
      .def_property_readonly("state", &Work::state, "How the bus stands.")
      .def_property_readonly("counts", &Work::counts, "What went over their end of the bus.");
}

}  // namespace

void bind_served(py::module_& m) {
  using OnLoopback = ServedJoystick<can::LoopbackBus>;
  using OnSocketCan = ServedJoystick<can::SocketCan>;
  py::class_<OnLoopback> inside(
      m, "LoopbackJoystick",
      "A joystick of simulated drives on a bus inside this process, in real time, in a thread of\n"
      "its own that never waits for Python. A context manager.");
  inside.def(
      py::init([](can::LoopbackHub& hub, const Setup& setup, int first, double peak_time,
                  const Felt& felt, bool wait_for_power, const Aim& aim) {
        PlantOfDrives joystick = make_joystick(setup, first, peak_time, felt, wait_for_power, aim);
        return std::make_unique<OnLoopback>(hub.open({.frames = kFrames}), std::move(joystick));
      }),
      py::arg("hub"), py::arg("setup"), py::kw_only(), py::arg("first") = 1,
      py::arg("peak_time") = 2.0, py::arg("felt") = py::none(), py::arg("wait_for_power") = false,
      py::arg("aim") = py::none());
  add_work(inside);
  py::class_<OnSocketCan> outside(
      m, "SocketCanJoystick",
      "A joystick of simulated drives on a CAN interface of the Linux kernel, in real time, in a\n"
      "thread of its own that never waits for Python. A context manager.");
  outside.def(
      py::init([](const std::string& interface, const Setup& setup, int first, double peak_time,
                  const Felt& felt, bool wait_for_power, const Aim& aim) {
        PlantOfDrives joystick = make_joystick(setup, first, peak_time, felt, wait_for_power, aim);
        return std::make_unique<OnSocketCan>(open_socketcan(interface, {}), std::move(joystick));
      }),
      py::arg("interface"), py::arg("setup"), py::kw_only(), py::arg("first") = 1,
      py::arg("peak_time") = 2.0, py::arg("felt") = py::none(), py::arg("wait_for_power") = false,
      py::arg("aim") = py::none());
  add_work(outside);
}

}  // namespace ebac::python
