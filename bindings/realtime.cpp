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
#include "ebac/rt/jitter.hpp"
#include "ebac/rt/shared_hand_target.hpp"
#include "ebac/rt/thread.hpp"
#include "fields.hpp"
#include "from_system.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

void bind_options(py::module_& m) {
  py::native_enum<rt::Mode>(m, "RealTimeMode", "enum.IntEnum",
                            "Treatment of refused real-time resources.")
      .value("OFF", rt::Mode::kOff)
      .value("AUTO", rt::Mode::kAuto)
      .value("ENFORCE", rt::Mode::kEnforce)
      .finalize();
  bind_fields<rt::Options>(m, "RealTime", "Real-time resources for the thread of a loop.");
  py::class_<rt::Grant>(m, "Grant", "One resource that a thread requested from the system.")
      .def(py::init([](std::string name, std::string asked, bool granted, std::string why,
                       std::string remedy) {
             return rt::Grant{std::move(name), std::move(asked), granted, std::move(why),
                              std::move(remedy)};
           }),
           py::kw_only(), py::arg("name"), py::arg("asked"), py::arg("granted"), py::arg("why"),
           py::arg("remedy"))
      .def_readonly("name", &rt::Grant::name, "priority, cpu, memory, stack or sleep.")
      .def_readonly("asked", &rt::Grant::asked, "Requested resource.")
      .def_readonly("granted", &rt::Grant::granted, "Whether it was granted.")
      .def_readonly("why", &rt::Grant::why, "Reason of a refusal; empty if granted.")
      .def_readonly("remedy", &rt::Grant::remedy, "The command that would grant it.")
      .def("__repr__", [](const rt::Grant& one) {
        return "<Grant " + one.name + ": " + one.asked +
               (one.granted ? ", granted" : ", not granted: " + one.why) + ">";
      });
}

void bind_aim(py::module_& m) {
  py::class_<rt::SharedHandTarget, std::shared_ptr<rt::SharedHandTarget>>(
      m, "SharedHandTarget",
      "Target of a simulated hand, from a loop to the simulation of the hand in another thread\n"
      "or another process, which opens it by its descriptor. One writer, one reader.")
      .def(py::init(
          [] { return from_system([] { return std::make_shared<rt::SharedHandTarget>(); }); }))
      .def(py::init([](int descriptor) {
             return from_system([&] { return std::make_shared<rt::SharedHandTarget>(descriptor); });
           }),
           py::arg("descriptor"))
      .def(
          "post",
          [](rt::SharedHandTarget& cell, const std::array<double, kMaxAxes>& target) {
            cell.post({.target = target});
          },
          py::arg("target"), "Set the target [m] per axis; NaN leaves an axis unchanged.")
      .def_property_readonly("descriptor", &rt::SharedHandTarget::descriptor,
                             "File descriptor to pass to another process.");
}

/// Waits in short pieces for what runs in another thread, so that an interrupt of Python ends it.
template <class T>
T interruptible(std::future<T> work, std::atomic<bool>& cancelled) {
  for (;;) {
    {
      const OthersRun release;
      if (work.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      cancelled = true;
      const OthersRun release;
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
        py::arg("options"),
        "Measure the lateness of every wake-up [s]; return it with skipped ticks and grants.");
  m.def(
      "_ask_realtime",
      [](const rt::Options& options) {
        const OthersRun release;
        const rt::Thread thread(rt::Mode::kAuto, options, [] {});
        return thread.report().grants;
      },
      py::arg("options"), "Return the grants for a thread of this process.");
}

}  // namespace ebac::python
