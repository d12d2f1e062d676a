#include <pybind11/native_enum.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "ebac/core/timing.hpp"
#include "ebac/rt/aim_cell.hpp"
#include "ebac/rt/jitter.hpp"
#include "ebac/rt/thread.hpp"
#include "fields.hpp"
#include "from_system.hpp"

namespace ebac::python {

namespace {

void bind_options(py::module_& m) {
  py::native_enum<rt::Mode>(m, "RealTimeMode", "enum.IntEnum", "What a loop's thread insists on.")
      .value("OFF", rt::Mode::kOff)
      .value("AUTO", rt::Mode::kAuto)
      .value("ENFORCE", rt::Mode::kEnforce)
      .finalize();
  bind_fields<rt::Options>(m, "RealTime", "What a loop's thread asks of the system.");
  py::class_<rt::Grant>(m, "Grant", "One thing a thread asked of the system.")
      .def(py::init([](std::string name, std::string asked, bool granted, std::string why,
                       std::string remedy) {
             return rt::Grant{std::move(name), std::move(asked), granted, std::move(why),
                              std::move(remedy)};
           }),
           py::kw_only(), py::arg("name"), py::arg("asked"), py::arg("granted"), py::arg("why"),
           py::arg("remedy"))
      .def_readonly("name", &rt::Grant::name, "priority, cpu, memory or stack.")
      .def_readonly("asked", &rt::Grant::asked, "What was asked.")
      .def_readonly("granted", &rt::Grant::granted, "Whether it was granted.")
      .def_readonly("why", &rt::Grant::why, "Why not; empty when it was.")
      .def_readonly("remedy", &rt::Grant::remedy, "The command that would grant it.");
}

void bind_aim(py::module_& m) {
  py::class_<rt::AimCell, std::shared_ptr<rt::AimCell>>(
      m, "AimCell",
      "Where a simulated hand should go: from a loop to who simulates the hand, in another thread\n"
      "or in another process, which has it by the descriptor handed down. One writer, one reader.")
      .def(py::init([] { return from_system([] { return std::make_shared<rt::AimCell>(); }); }))
      .def(py::init([](int descriptor) {
             return from_system([&] { return std::make_shared<rt::AimCell>(descriptor); });
           }),
           py::arg("descriptor"))
      .def(
          "post",
          [](rt::AimCell& cell, const std::array<double, kMaxAxes>& target) {
            cell.post({.target = target});
          },
          py::arg("target"), "The target from now on [m]; no number leaves an axis alone.")
      .def_property_readonly("descriptor", &rt::AimCell::descriptor, "To be handed down.");
}

/// Waits in short pieces for what runs in another thread, so that an interrupt of Python ends it.
template <class T>
T interruptible(std::future<T> work, std::atomic<bool>& cancelled) {
  for (;;) {
    {
      const py::gil_scoped_release release;
      if (work.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      cancelled = true;
      const py::gil_scoped_release release;
      work.wait();
      break;
    }
  }
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return work.get();
}

std::tuple<py::array_t<double>, std::int64_t, std::vector<rt::Grant>> jitter(
    double dt, std::int64_t ticks, rt::Mode mode, const rt::Options& options) {
  check(options, "RealTime");
  check(Timing{.dt = dt}, "Timing");
  std::atomic<bool> cancelled = false;
  const rt::Jitter found = interruptible(
      std::async(std::launch::async,
                 [&] { return rt::measure_jitter(dt, ticks, mode, options, cancelled); }),
      cancelled);
  return std::make_tuple(
      py::array_t<double>(static_cast<py::ssize_t>(found.lateness.size()), found.lateness.data()),
      found.skipped, found.report.grants);
}

}  // namespace

void bind_realtime(py::module_& m) {
  bind_options(m);
  bind_aim(m);
  m.def("_measure_jitter", &jitter, py::arg("dt"), py::arg("ticks"), py::arg("mode"),
        py::arg("options"), "Lateness of every wake-up [s], ticks skipped, what was granted.");
  m.def(
      "_ask_realtime",
      [](const rt::Options& options) {
        const py::gil_scoped_release release;
        const rt::Thread thread(rt::Mode::kAuto, options, [] {});
        return thread.report().grants;
      },
      py::arg("options"), "What a thread of this process would be granted.");
}

}  // namespace ebac::python
