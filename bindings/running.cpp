#include "running.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <thread>
#include <tuple>

#include "bind.hpp"
#include "open_socketcan.hpp"

namespace ebac::python {

namespace {

/// Frames that wait for a loop that was held up.
constexpr std::size_t kFrames = 4096;
/// Longest sleep of `wait` at a time: how late its end is noticed.
constexpr std::chrono::milliseconds kLook{2};

can::CanopenSetup drives_of(const DeviceModel& device, const std::vector<int>& nodes,
                            const Values& more) {
  can::CanopenSetup drives{.axes = device.axes(), .motor = device.motor, .drive = device.drive};
  if (nodes.size() != static_cast<std::size_t>(drives.axes)) {
    throw std::invalid_argument("RunSetup.nodes: " + std::to_string(nodes.size()) +
                                " drives for a device of " + std::to_string(drives.axes) +
                                " axes: give one for each");
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 1 || nodes[i] > can::kLastNode) {
      throw std::invalid_argument(
          range_message("RunSetup", "nodes", nodes[i], "1", 1, can::kLastNode));
    }
    drives.node[i] = static_cast<can::NodeId>(nodes[i]);
  }
  for (const auto& [key, item] : more) {
    const auto word = py::cast<std::string>(key);
    if (!set_field(drives, "RunSetup", word, item))
      refuse_keyword("RunSetup", word, field_names<can::CanopenSetup>());
  }
  check_setup(drives);
  return drives;
}

RunSetup make_setup(const DeviceModel& device, const Environment& environment, double dt,
                    const std::vector<int>& nodes, double answer_time, const RunPlan& plan,
                    const std::optional<Limits>& limits,
                    const std::optional<sensor::RdtClientSetup>& sensor, std::size_t rows,
                    bool ring, rt::Mode mode, const rt::Options& realtime, const Values& drives,
                    const std::optional<std::shared_ptr<rt::AimCell>>& aim) {
  check(Timing{.dt = dt}, "Timing");
  const bool fits = answer_time > 0 && answer_time <= dt;
  if (!fits) {
    throw std::invalid_argument(range_message("RunSetup", "answer_time", answer_time, "s", 0, dt));
  }
  if (rows < 1) throw std::invalid_argument("RunSetup.rows = 0 rows: must be at least 1");
  return {.device = device,
          .environment = environment,
          .dt = dt,
          .answer_time = answer_time,
          .drives = drives_of(device, nodes, drives),
          .sensor = sensor,
          .aim = aim.value_or(nullptr),
          .limits = limits,
          .plan = plan,
          .rows = rows,
          .ring = ring,
          .mode = mode,
          .realtime = realtime};
}

using Told = std::tuple<std::int64_t, std::uint64_t, std::string>;

/// Changes from number `start` on: from which tick, serial number, of what.
std::vector<Told> changes_from(const Running& run, std::size_t start) {
  const auto name = [](ChangeOf what) {
    switch (what) {
      case ChangeOf::kLaw:
        return "law";
      case ChangeOf::kEnvironment:
        return "environment";
      case ChangeOf::kTarget:
        return "target";
    }
    return "";
  };
  std::vector<Told> told;
  const Changes& changes = run.changes();
  for (std::size_t i = start; i < changes.size(); ++i) {
    told.emplace_back(changes[i].tick, changes[i].serial, name(changes[i].what));
  }
  return told;
}

/// Whether it ended within `seconds`; other threads of Python run meanwhile.
bool wait_for(const Running& run, double seconds) {
  const py::gil_scoped_release others_run;
  const auto most = std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6));
  const auto end = std::chrono::steady_clock::now() + most;
  while (!run.done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kLook);
  return run.done();
}

void require_done(const Running& run) {
  if (!run.done()) throw std::logic_error("the loop still runs: join it first");
}

void bind_running_class(py::module_& m) {
  py::class_<Running>(m, "Running", "A loop at work in a thread that never touches Python.")
      .def_readonly("rows", &Running::trace, "Its rows; they grow while it runs.")
      .def_readonly("grants", &Running::grants, "What its thread asked of the system, and got.")
      .def(
          "stop", [](const Running& run) { run.stop(); }, "Asks for a stop.")
      .def(
          "join",
          [](const Running& run) {
            const py::gil_scoped_release others_run;
            run.join();
          },
          "Waits for its end.")
      .def("wait", &wait_for, py::arg("seconds"), "Whether it ended within so long [s].")
      .def_property_readonly(
          "done", [](const Running& run) { return run.done(); }, "Whether it ended.")
      .def_property_readonly(
          "at_rest", [](const Running& run) { return require_done(run), run.at_rest(); },
          "Whether every drive said in the last tick that its power is off. Once it ended.")
      .def_property_readonly(
          "state", [](const Running& run) { return require_done(run), run.state(); },
          "Where it ended: idle, or fault.")
      .def_property_readonly(
          "unrecorded", [](const Running& run) { return run.unrecorded(); },
          "Ticks that found the trace full.")
      .def_property_readonly(
          "bus", [](const Running& run) { return run.bus(); }, "What went over its end of the bus.")
      .def(
          "retune", [](const Running& run, const py::object& law) { return run.retune(law); },
          py::arg("law"), "The gains of this law from the next tick on; returns a serial number.")
      .def(
          "change_world",
          [](const Running& run, const Environment& world) { return run.change_world(world); },
          py::arg("environment"), "Another virtual world from the next tick on.")
      .def(
          "aim",
          [](const Running& run, const std::array<double, kMaxAxes>& target) {
            return run.aim({.target = target});
          },
          py::arg("target"),
          "Where a simulated hand should go [m]; no number leaves an axis alone.")
      .def("changes", &changes_from, py::arg("start") = 0,
           "What the loop took: (tick, serial number, what).")
      .def_property_readonly(
          "changes_lost", [](const Running& run) { return run.changes().lost(); },
          "Changes that acted, but of which no note was kept.");
}

}  // namespace

can::EitherBus take_bus(const py::object& bus) {
  if (py::isinstance<py::str>(bus)) {
    return can::EitherBus(open_socketcan(bus.cast<std::string>(), {}));
  }
  return can::EitherBus(bus.cast<can::LoopbackHub&>().open({.frames = kFrames}));
}

void bind_running(py::module_& m) {
  bind_fields<RunPlan>(m, "RunPlan", "How a run begins and ends.");
  py::class_<RunSetup>(m, "RunSetup", "All that a run is but its bus and its law.")
      .def(py::init(&make_setup), py::kw_only(), py::arg("device"), py::arg("environment"),
           py::arg("dt"), py::arg("nodes"), py::arg("answer_time"), py::arg("plan"),
           py::arg("limits"), py::arg("sensor"), py::arg("rows"), py::arg("ring"), py::arg("mode"),
           py::arg("realtime"), py::arg("drives"), py::arg("aim") = py::none(),
           "`drives` are the fields of CanopenSetup by name.");
  bind_running_class(m);
}

}  // namespace ebac::python
