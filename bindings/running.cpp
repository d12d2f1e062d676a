#include "running.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <thread>
#include <tuple>

#include "axes_argument.hpp"
#include "bind.hpp"
#include "open_socketcan.hpp"
#include "others_run.hpp"
#include "stepped_run.hpp"
#include "zero.hpp"

namespace ebac::python {

namespace {

/// Frames that wait for a loop that was held up.
constexpr std::size_t kFrames = 4096;
/// Longest sleep of `wait` at a time: how late its end is noticed.
constexpr std::chrono::milliseconds kLook{2};

/// Signs of each axis; none given are all 1.
std::array<int, kMaxAxes> signs_of(const char* name, const std::vector<int>& given, int axes) {
  std::array<int, kMaxAxes> signs{1, 1, 1};
  if (given.empty()) return signs;
  check_axes("RunSetup." + std::string(name), given.size(), axes);
  std::ranges::copy(given, signs.begin());
  return signs;
}

can::CanopenSetup drives_of(const DeviceModel& device, const std::vector<int>& nodes,
                            const std::vector<int>& motor_sign,
                            const std::vector<int>& encoder_sign,
                            const std::vector<std::int64_t>& encoder_zero, const Values& more) {
  can::CanopenSetup drives{.axes = device.axes(), .motor = device.motor, .drive = device.drive};
  check_axes("RunSetup.nodes", nodes.size(), drives.axes);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 1 || nodes[i] > can::kLastNode) {
      throw std::invalid_argument(
          range_message("RunSetup", "nodes", nodes[i], "1", 1, can::kLastNode));
    }
    drives.node[i] = static_cast<can::NodeId>(nodes[i]);
  }
  for (const auto& [key, item] : more) {
    const auto word = py::cast<std::string>(key);
    const FieldTable& table = field_table<can::CanopenSetup>();
    if (!set_field(table, &drives, "RunSetup", word, item))
      refuse_keyword("RunSetup", word, field_names(table));
  }
  drives.motor_sign = signs_of("motor_sign", motor_sign, drives.axes);
  drives.encoder_sign = signs_of("encoder_sign", encoder_sign, drives.axes);
  drives.encoder_zero = zero_of("RunSetup", "encoder_zero", encoder_zero, drives.axes);
  check_setup(drives);
  return drives;
}

RunSetup make_setup(const DeviceModel& device, const Environment& environment, double dt,
                    const std::vector<int>& nodes, double answer_time, const RunPlan& plan,
                    const std::optional<Limits>& limits,
                    const std::optional<sensor::RdtClientSetup>& sensor, std::size_t rows,
                    bool ring, rt::Mode mode, const rt::Options& realtime, const Values& drives,
                    const std::optional<std::shared_ptr<rt::SharedHandTarget>>& aim,
                    const std::optional<ObserverParams>& observer,
                    const std::vector<int>& motor_sign, const std::vector<int>& encoder_sign,
                    const std::vector<std::int64_t>& encoder_zero) {
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
          .drives = drives_of(device, nodes, motor_sign, encoder_sign, encoder_zero, drives),
          .sensor = sensor,
          .aim = aim.value_or(nullptr),
          .limits = limits,
          .observer = observer,
          .plan = plan,
          .rows = rows,
          .ring = ring,
          .mode = mode,
          .realtime = realtime};
}

using AppliedChange = std::tuple<std::int64_t, std::uint64_t, std::string>;

/// Changes from number `start` on, as far as they are kept: from which tick, serial number, of what.
std::vector<AppliedChange> changes_from(Running& run, std::size_t start) {
  const auto name = [](UpdateOf what) {
    switch (what) {
      case UpdateOf::kLaw:
        return "law";
      case UpdateOf::kEnvironment:
        return "environment";
      case UpdateOf::kTarget:
        return "target";
      case UpdateOf::kDelay:
        return "delay";
    }
    return "";
  };
  std::vector<AppliedChange> found;
  AppliedUpdates& changes = run.changes();
  changes.read(start);
  for (std::size_t i = changes.first(); i < changes.size(); ++i) {
    found.emplace_back(changes[i].tick, changes[i].serial, name(changes[i].what));
  }
  return found;
}

void require_done(const Running& run) {
  if (!run.done()) throw std::logic_error("the loop still runs: join it first");
}

void bind_stepped_run(py::module_& m) {
  py::class_<SteppedRun, Running, std::shared_ptr<SteppedRun>>(
      m, "SteppedRun", "A loop on a virtual clock that takes its ticks when it is asked to.")
      .def(
          "advance",
          [](SteppedRun& run, std::int64_t ticks) {
            const OthersRun others_run;
            return run.advance(ticks);
          },
          py::arg("ticks"), "Take so many ticks, fewer where the run ends; return how many.")
      // They wait for `advance`, which may wait for Python: a world may be a function of it.
      .def("aim_now", &SteppedRun::aim, py::arg("target"), py::call_guard<OthersRun>(),
           "Set the target of the hand [m] before the next tick, without a note; NaN leaves an "
           "axis unchanged.")
      .def("switch_off", &SteppedRun::switch_off, py::call_guard<OthersRun>(),
           "Disable the drives. Raises RuntimeError when one stays on.");
}

void bind_running_class(py::module_& m) {
  py::class_<Running, std::shared_ptr<Running>>(m, "Running",
                                                "A running loop that never touches Python.")
      .def_property_readonly(
          "rows", [](const Running& run) { return run.trace(); },
          "Rows of the trace; they grow while the loop runs.")
      .def_property_readonly(
          "grants", [](const Running& run) { return run.grants(); },
          "Resources that its thread requested and was granted.")
      .def(
          "stop", [](const Running& run, bool at_once) { run.stop(at_once); },
          py::arg("at_once") = false, "Request a stop; at once: without the ramp of the force.")
      .def(
          "join",
          [](Running& run) {
            const OthersRun others_run;
            run.join();
          },
          "Wait until the loop has ended.")
      .def(
          "wait",
          [](Running& run, double seconds) {
            const OthersRun others_run;
            return run.wait(seconds);
          },
          py::arg("seconds"), "Wait up to `seconds` [s]; return whether the loop has ended.")
      .def_property_readonly(
          "done", [](const Running& run) { return run.done(); }, "Whether the loop has ended.")
      .def_property_readonly(
          "at_rest", [](const Running& run) { return require_done(run), run.at_rest(); },
          "Whether every drive reported power off in the last tick. Only after the loop has ended.")
      .def_property_readonly(
          "state", [](const Running& run) { return require_done(run), run.state(); },
          "Final state: idle or fault.")
      .def_property_readonly(
          "unrecorded", [](const Running& run) { return run.unrecorded(); },
          "Ticks not recorded because the trace was full.")
      .def_property_readonly(
          "bus", [](const Running& run) { return run.bus(); },
          "Frame counts of its end of the bus.")
      .def(
          "retune", [](Running& run, const AnyLaw& law) { return run.retune(law); }, py::arg("law"),
          "Apply the gains of `law` from the next tick on; return the serial number of the update.")
      .def(
          "replace_law", [](Running& run, const AnyLaw& law) { return run.replace(law); },
          py::arg("law"),
          "Let another law take over from the next tick on, its force blended in over 50 ms; "
          "return "
          "the serial number of the update.")
      .def(
          "hold_back",
          [](Running& run, std::size_t ticks) {
            if (ticks > Hardware::kMost) {
              throw std::invalid_argument(range_message("Running.hold_back", "ticks",
                                                        static_cast<double>(ticks), "samples", 0,
                                                        static_cast<double>(Hardware::kMost)));
            }
            return run.post(CommandDelay{.ticks = ticks});
          },
          py::arg("ticks"),
          "Hold each command back by so many more ticks, 0 to 7; for simulated drives. Return the "
          "serial number of the update.")
      .def(
          "change_world", [](Running& run, const Environment& world) { return run.post(world); },
          py::arg("environment"),
          "Apply another environment from the next tick on; return the serial number of the "
          "update.")
      .def(
          "aim",
          [](Running& run, const std::array<double, kMaxAxes>& target) {
            return run.post(HandTarget{.target = target});
          },
          py::arg("target"),
          "Set the target of a simulated hand [m]; NaN leaves an axis unchanged.")
      .def("changes", &changes_from, py::arg("start") = 0,
           "Return the applied updates from number `start` on, and forget those before: (tick, "
           "serial "
           "number, parameter).")
      .def_property_readonly(
          "changes_lost", [](const Running& run) { return run.changes().lost(); },
          "Updates that were applied but not recorded.");
}

}  // namespace

bool Running::wait(double seconds) {
  const auto most = std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6));
  const auto end = std::chrono::steady_clock::now() + most;
  while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kLook);
  return done();
}

can::AnyBus take_bus(const py::object& bus) {
  if (py::isinstance<py::str>(bus)) {
    return can::AnyBus(open_socketcan(bus.cast<std::string>(), {}));
  }
  return can::AnyBus(bus.cast<can::LoopbackHub&>().open({.frames = kFrames}));
}

void bind_running(py::module_& m) {
  bind_fields<RunPlan>(m, "RunPlan", "Start and end of a run.");
  py::class_<RunSetup>(m, "RunSetup", "Setup of a run on hardware, without its bus and its law.")
      .def(py::init(&make_setup), py::kw_only(), py::arg("device"), py::arg("environment"),
           py::arg("dt"), py::arg("nodes"), py::arg("answer_time"), py::arg("plan"),
           py::arg("limits"), py::arg("sensor"), py::arg("rows"), py::arg("ring"), py::arg("mode"),
           py::arg("realtime"), py::arg("drives"), py::arg("aim") = py::none(),
           py::arg("observer") = py::none(), py::arg("motor_sign") = std::vector<int>{},
           py::arg("encoder_sign") = std::vector<int>{},
           py::arg("encoder_zero") = std::vector<std::int64_t>{},
           "`drives` are the fields of CanopenSetup by name.");
  bind_running_class(m);
  bind_stepped_run(m);
}

}  // namespace ebac::python
