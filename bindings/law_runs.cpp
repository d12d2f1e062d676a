#include <pybind11/stl.h>

#include "ebac/sim/any_law.hpp"
#include "ebac/sim/simulate.hpp"
#include "ebac/simulated_drives/through_can.hpp"
#include "law_class.hpp"
#include "others_run.hpp"
#include "replay.hpp"
#include "simulate_either.hpp"
#include "sweep.hpp"

/// What every law can be run in: the methods `_simulate`, `_replay`, `_sweep`, `_press`, `_time_step`
/// and `_time_tick`.
namespace ebac::python {

namespace {

using Setups = std::vector<const Setup*>;
using AnyLaws = std::vector<const AnyLaw*>;

const char* const kSetups = "setups: collections.abc.Sequence[ebac._core.Setup], ";
const char* const kLaws = "laws: collections.abc.Sequence[LAW], ";
const char* const kGoals =
    "goals: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], ";
const char* const kRest =
    "threads: typing.SupportsInt | typing.SupportsIndex, limits: ebac._core.RunLimits, progress: "
    "ebac._core.SweepProgress) -> dict[str, object]";

void require_parts(const Setups& setups, const AnyLaws& laws) {
  require_all(setups, "setups");
  require_all(laws, "laws");
}

void add_sweep(const LawClass& law) {
  const auto run = [](const Setups& setups, const AnyLaws& laws, int threads,
                      const RunLimits& limits, SweepProgress& progress) {
    require_parts(setups, laws);
    if (setups.size() != laws.size()) {
      throw std::invalid_argument(std::to_string(laws.size()) + " laws for " +
                                  std::to_string(setups.size()) + " setups: give one for each");
    }
    std::vector<Outcome> outcomes;
    {
      const OthersRun release;
      outcomes = sweep_any(setups, laws, threads, limits, progress);
    }
    return columns_of(outcomes);
  };
  law.def_static("_sweep", run, std::string("(") + kSetups + kLaws + kRest, "", py::arg("setups"),
                 py::arg("laws"), py::arg("threads"), py::arg("limits"), py::arg("progress"));
}

/// Presses on a wall, from which the gains of eq. (2) are chosen.
void add_press(const LawClass& law) {
  const auto run = [](const Setups& setups, const AnyLaws& laws, const std::vector<double>& goals,
                      int threads, const RunLimits& limits, SweepProgress& progress) {
    require_parts(setups, laws);
    if (setups.size() != laws.size() || setups.size() != goals.size()) {
      throw std::invalid_argument("setups, laws and goals: give one of each for every run");
    }
    std::vector<Press> rows;
    {
      const OthersRun release;
      rows = press_any(setups, laws, goals, threads, limits, progress);
    }
    std::vector<Outcome> outcomes;
    outcomes.reserve(rows.size());
    for (const Press& row : rows) outcomes.push_back(row.outcome);
    Values columns = columns_of(outcomes);
    add_columns<PressEffort>(columns, rows,
                             [](const Press& p) -> const PressEffort& { return p.effort; });
    return columns;
  };
  law.def_static("_press", run, std::string("(") + kSetups + kLaws + kGoals + kRest, "",
                 py::arg("setups"), py::arg("laws"), py::arg("goals"), py::arg("threads"),
                 py::arg("limits"), py::arg("progress"));
}

/// Whether it has the force loop of eq. (2).
bool has_force_loop(const LawType& type) {
  return type.params.find("kp") != nullptr && type.params.find("kd") != nullptr;
}

template <double (*time)(const Setup&, const AnyLaw&, int)>
void add_time(const LawClass& law, const char* name) {
  law.def(
      name,
      [](const AnyLaw& any, const Setup& setup, int repeats) {
        const OthersRun release;
        return time(setup, any, repeats);
      },
      "(self: LAW, setup: ebac._core.Setup, repeats: typing.SupportsInt | typing.SupportsIndex) -> "
      "float",
      "", py::arg("setup"), py::arg("repeats"));
}

}  // namespace

std::shared_ptr<Trace> simulate_either(const Setup& setup, const AnyLaw& law, bool through_can,
                                       const std::optional<can::TimedBus>& bus) {
  if (!through_can) return simulate_any(setup, law);
  return can::simulate_through_can<SimulatedDevice>(setup, PerAxis<AnyLaw>(law), row_count(setup),
                                                    bus);
}

std::shared_ptr<Trace> replay_on(const std::shared_ptr<ReplayLog>& log, const AnyLaw& law,
                                 const DeviceModel& device, const Environment& environment) {
  if (log->axes != static_cast<std::size_t>(device.axes())) {
    throw std::invalid_argument("replay: the log has " + std::to_string(log->axes) +
                                " axes, the device " + std::to_string(device.axes()));
  }
  return replay_any(log, law, device, environment);
}

void add_runs(const LawClass& law) {
  law.def(
      "_simulate",
      [](const AnyLaw& any, const Setup& setup, bool through_can,
         const std::optional<can::TimedBus>& bus) {
        const OthersRun release;
        return simulate_either(setup, any, through_can, bus);
      },
      "(self: LAW, setup: ebac._core.Setup, through_can: bool = False, bus: "
      "ebac._core.TimedBus | None = None) -> ebac._core.Rows",
      "", py::arg("setup"), py::arg("through_can") = false, py::arg("bus") = py::none());
  law.def(
      "_replay",
      [](const AnyLaw& any, const std::shared_ptr<ReplayLog>& log, const DeviceModel& device,
         const Environment& environment) {
        const OthersRun release;
        return replay_on(log, any, device, environment);
      },
      "(self: LAW, log: ebac._core.ReplayLog, device: ebac._core.Device, environment: "
      "ebac._core.Free | ebac._core.Wall | ebac._core.Corner | ebac._core.Disc | "
      "ebac._core._World) "
      "-> ebac._core.Rows",
      "", py::arg("log"), py::arg("device"), py::arg("environment"));
  add_sweep(law);
  if (has_force_loop(*law.type)) add_press(law);
  add_time<&time_law_any>(law, "_time_step");
  add_time<&time_loop_any>(law, "_time_tick");
}

}  // namespace ebac::python
