#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>

#include "bind.hpp"
#include "ebac/sensor/emulator_server.hpp"
#include "ebac/sensor/shared_force.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "others_run.hpp"
#include "sensor.hpp"

namespace ebac::python {

namespace {

using sensor::EmulatorCounts;
using sensor::EmulatorOptions;
using sensor::EmulatorServer;
using sensor::EmulatorTrouble;
using sensor::RdtEmulator;
using sensor::SharedForce;

/// The hand of a setup on its device, whose motors have no current.
EmulatorServer::Source from_hand(const Setup& setup) {
  return [device = SimulatedDevice(setup)](double elapsed) mutable {
    return device.exchange({.elapsed = elapsed}).force;
  };
}

/// Its thread may call a hand in Python.
using EmulatorHolder = std::unique_ptr<EmulatorServer, WithoutLock>;
using EmulatorClass = py::class_<EmulatorServer, EmulatorHolder>;

EmulatorHolder serve(const std::string& host, int port, const EmulatorOptions& options,
                     const std::array<double, 9>& rotation, int sign, sensor::SensorModel model,
                     std::uint64_t seed, EmulatorServer::Source source) {
  const sensor::Endpoint at = resolved(host, checked_port(port, 0));
  const RdtEmulator<sensor::Endpoint> emulator(options, checked_mounting(rotation, sign),
                                               sensor::StatusBits::of(model), seed);
  return from_system(
      [&] { return EmulatorHolder(new EmulatorServer(at, emulator, std::move(source))); });
}

template <class Source, class Turn>
void add_init(EmulatorClass& cls, Turn turn) {
  cls.def(py::init([turn](const std::string& host, int port, const Source& source,
                          const EmulatorOptions& options, const std::array<double, 9>& rotation,
                          int sign, sensor::SensorModel model, std::uint64_t seed) {
            return serve(host, port, options, rotation, sign, model, seed, turn(source));
          }),
          py::arg("host"), py::arg("port"), py::arg("source"), py::kw_only(), py::arg("options"),
          py::arg("rotation"), py::arg("sign"), py::arg("model"), py::arg("seed"));
}

void bind_values(py::module_& m) {
  bind_fields<EmulatorOptions>(m, "EmulatorOptions", "Properties of an emulated force sensor.");
  bind_fields<EmulatorTrouble>(m, "EmulatorTrouble", "Errors of an emulated force sensor.");
  py::class_<EmulatorCounts> counts(m, "EmulatorCounts", "Counts of an emulated sensor.");
  add_members(counts, field_table<EmulatorCounts>(), &place_of<EmulatorCounts>);
  py::class_<SharedForce, std::shared_ptr<SharedForce>>(
      m, "SharedForce",
      "The force at a handle, from a simulated hand to an emulated sensor. One writer, one reader.")
      .def(py::init([](const std::array<double, kMaxAxes>& force) {
             auto cell = std::make_shared<SharedForce>();
             cell->post(force);
             return cell;
           }),
           py::arg("force") = std::array<double, kMaxAxes>{})
      .def("post", &SharedForce::post, py::arg("force"), "Set the force [N].");
}

}  // namespace

void bind_sensor_emulator(py::module_& m) {
  bind_values(m);
  EmulatorClass cls(
      m, "RdtEmulator",
      "An emulated force/torque sensor on the network, in real time, in a thread of its own "
      "that\n"
      "never waits for Python. `source` is a shared force, or a setup with device and hand.");
  add_init<std::shared_ptr<SharedForce>>(
      cls, [](std::shared_ptr<SharedForce> cell) { return sensor::from_cell(std::move(cell)); });
  add_init<Setup>(cls, [](const Setup& setup) { return from_hand(setup); });
  cls.def("start", &EmulatorServer::start, py::arg_v("mode", rt::Mode::kOff, "RealTimeMode.OFF"),
          py::arg("realtime") = rt::Options{}, "Start the sensor on the network; possible once.")
      .def_property_readonly(
          "grants", &EmulatorServer::grants,
          "Resources that its thread requested and was granted; empty before the start.")
      .def("stop", &EmulatorServer::stop, py::call_guard<OthersRun>(), "Stop the sensor for good.")
      .def("set", &EmulatorServer::set, py::arg("trouble"), "Set the errors to emulate.")
      .def_property_readonly("counts", &EmulatorServer::counts, "Counts so far.")
      .def_property_readonly(
          "address",
          [](const EmulatorServer& self) {
            const std::string text = to_string(self.local());
            return std::make_pair(text.substr(0, text.find(':')),
                                  static_cast<int>(self.local().port));
          },
          "Host and port.");
}

}  // namespace ebac::python
