#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>

#include "bind.hpp"
#include "ebac/sensor/felt.hpp"
#include "ebac/sensor/served_emulator.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "sensor.hpp"

namespace ebac::python {

namespace {

using sensor::EmulatorCounts;
using sensor::EmulatorOptions;
using sensor::EmulatorTrouble;
using sensor::ForceCell;
using sensor::RdtEmulator;
using sensor::ServedEmulator;

/// The hand of a setup on its device, whose motors have no current.
ServedEmulator::Source from_hand(const Setup& setup) {
  return [device = SimulatedDevice(setup)](double elapsed) mutable {
    return device.exchange({.elapsed = elapsed}).force;
  };
}

std::unique_ptr<ServedEmulator> serve(const std::string& host, int port,
                                      const EmulatorOptions& options,
                                      const std::array<double, 9>& rotation, int sign,
                                      sensor::SensorModel model, std::uint64_t seed,
                                      ServedEmulator::Source source) {
  const sensor::Endpoint at = sensor::resolve(host, checked_port(port, 0));
  const RdtEmulator<sensor::Endpoint> emulator(options, checked_mounting(rotation, sign),
                                               sensor::StatusBits::of(model), seed);
  return from_system(
      [&] { return std::make_unique<ServedEmulator>(at, emulator, std::move(source)); });
}

template <class Source, class Turn>
void add_init(py::class_<ServedEmulator>& cls, Turn turn) {
  cls.def(py::init([turn](const std::string& host, int port, const Source& source,
                          const EmulatorOptions& options, const std::array<double, 9>& rotation,
                          int sign, sensor::SensorModel model, std::uint64_t seed) {
            return serve(host, port, options, rotation, sign, model, seed, turn(source));
          }),
          py::arg("host"), py::arg("port"), py::arg("source"), py::kw_only(), py::arg("options"),
          py::arg("rotation"), py::arg("sign"), py::arg("model"), py::arg("seed"));
}

void bind_values(py::module_& m) {
  bind_fields<EmulatorOptions>(m, "EmulatorOptions", "How an emulated force sensor is built.");
  bind_fields<EmulatorTrouble>(m, "EmulatorTrouble",
                               "What goes wrong with an emulated force sensor.");
  py::class_<EmulatorCounts> counts(m, "EmulatorCounts", "What an emulated sensor did.");
  add_members<EmulatorCounts>(
      counts, [](const EmulatorCounts& self) -> const EmulatorCounts& { return self; });
  py::class_<ForceCell, std::shared_ptr<ForceCell>>(
      m, "ForceCell",
      "The force at a handle: from whoever moves it to an emulated sensor. One writer, one reader.")
      .def(py::init([](const std::array<double, kMaxAxes>& force) {
             auto cell = std::make_shared<ForceCell>();
             cell->post(force);
             return cell;
           }),
           py::arg("force") = std::array<double, kMaxAxes>{})
      .def("post", &ForceCell::post, py::arg("force"), "The force from now on [N].");
}

}  // namespace

void bind_sensor_emulator(py::module_& m) {
  bind_values(m);
  py::class_<ServedEmulator> cls(
      m, "RdtEmulator",
      "A force/torque sensor on the network that is none, in real time, in a thread of its own "
      "that\n"
      "never waits for Python. `source` is a cell with the force, or device and hand of a setup.");
  add_init<std::shared_ptr<ForceCell>>(
      cls, [](std::shared_ptr<ForceCell> cell) { return sensor::from_cell(std::move(cell)); });
  add_init<Setup>(cls, [](const Setup& setup) { return from_hand(setup); });
  cls.def("start", &ServedEmulator::start, py::arg_v("mode", rt::Mode::kOff, "RealTimeMode.OFF"),
          py::arg("realtime") = rt::Options{}, "Puts it on the network, once in a life.")
      .def_property_readonly(
          "grants", &ServedEmulator::grants,
          "What its thread asked of the system, and got; nothing before it is started.")
      .def("stop", &ServedEmulator::stop, py::call_guard<py::gil_scoped_release>(),
           "Takes it off for good.")
      .def("set", &ServedEmulator::set, py::arg("trouble"), "What goes wrong from now on.")
      .def_property_readonly("counts", &ServedEmulator::counts, "What it did so far.")
      .def_property_readonly(
          "address",
          [](const ServedEmulator& self) {
            const std::string text = to_string(self.local());
            return std::make_pair(text.substr(0, text.find(':')),
                                  static_cast<int>(self.local().port));
          },
          "Host and port where it is.");
}

}  // namespace ebac::python
