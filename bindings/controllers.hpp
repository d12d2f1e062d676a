#pragma once

#include <memory>
#include <string>

#include "ebac/sim/benchmark.hpp"
#include "fields.hpp"
#include "press.hpp"
#include "replay.hpp"
#include "simulate_either.hpp"
#include "sweep.hpp"

/// The Python class of a law, written once for all of them.
namespace ebac::python {

template <Controller Law>
Law make_law(const std::string& owner, typename Law::Params params, Timing timing,
             const py::kwargs& given) {
  for (const auto& [key, item] : given) {
    const auto word = py::cast<std::string>(key);
    if (word == "timing") {
      timing = item.template cast<Timing>();
    } else if (!set_field(params, owner, word, item)) {
      std::vector<std::string> known = field_names<typename Law::Params>();
      known.emplace_back("timing");
      refuse_keyword(owner, word, known);
    }
  }
  check(params, owner);
  return Law(params, timing);
}

template <Described State>
void bind_state(py::handle scope) {
  py::class_<State> cls(scope, "State", "What the law remembers and a trace records.");
  add_members<State>(cls, [](const State& self) -> const State& { return self; });
  cls.def("as_dict", &values_of<State>, "Values by name.");
  cls.def("__repr__", &represent);
}

/// `design(facts, timing, **changes)`, from the facts or from the device that has them.
template <Controller Law>
void bind_design(py::class_<Law>& cls, const std::string& owner) {
  using Facts = std::variant<DeviceFacts, DeviceModel>;
  const OwnSignatures own;
  cls.def_static(
      "design",
      [owner](const Facts& given, const Timing& timing, const py::kwargs& changes) {
        const auto* device = std::get_if<DeviceModel>(&given);
        const DeviceFacts facts =
            device != nullptr ? device->facts() : std::get<DeviceFacts>(given);
        return make_law<Law>(owner, Law::Params::design(facts, timing), timing, changes);
      },
      py::arg("facts"), py::arg("timing"),
      ("design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> " + owner +
       "\n\nThe law for a device: every parameter from what a user can know of it, changes on top.")
          .c_str());
}

/// Binds one law: class, state, design, stepping, simulation and benchmark.
template <Controller Law>
void bind_controller(py::module_& m, const char* name) {
  using Params = Law::Params;
  const std::string owner = name;
  const std::string keywords = signature(Params{}) + ", timing: Timing = ...";
  py::class_<Law> cls(m, name,
                      (std::string(Law::kSummary) + "." + parameter_table<Params>()).c_str());
  bind_state<typename Law::State>(cls);

  def_init(
      cls,
      [owner](const py::kwargs& given) { return make_law<Law>(owner, Params{}, Timing{}, given); },
      "__init__(self, *" + keywords + ") -> None");
  bind_design(cls, owner);
  add_members<Params>(cls, [](const Law& law) -> const Params& { return law.params(); });
  cls.def_property_readonly("timing", &Law::timing, "Sample time and delay the law counts with.");
  cls.def_property_readonly(
      "state", [](const Law& law) { return law.state(); },
      "What the law remembers, as of the last step.");
  cls.def(
      "as_dict",
      [](const Law& law) {
        Values values = values_of(law.params());
        values["timing"] = law.timing();
        return values;
      },
      "Parameters by name; not the state.");
  add_value_methods(cls);
  cls.def("step", &Law::step, py::arg("port"), "One tick of one axis: the force it commands [N].");
  cls.def("reset", &Law::reset, "Forgets everything but its parameters.");
  cls.def("copy", [](const Law& law) { return law; }, "An independent copy, state included.");
  cls.attr("name") = std::string(Law::kName);
  cls.attr("summary") = std::string(Law::kSummary);
  cls.attr("passive") = Law::kPassive;

  cls.def(
      "_simulate",
      [](const Law& law, const Setup& setup, bool through_can) {
        const py::gil_scoped_release release;
        return simulate_either(setup, PerAxis<Law>(law), through_can);
      },
      py::arg("setup"), py::arg("through_can") = false);
  bind_replay_of(cls);
  bind_sweep(cls);
  if constexpr (HasForceLoop<Law>) bind_press(cls);
  cls.def(
      "_time_step",
      [](const Law& law, const Setup& setup, int repeats) {
        const py::gil_scoped_release release;
        return time_law(setup, law, repeats);
      },
      py::arg("setup"), py::arg("repeats"));
  cls.def(
      "_time_tick",
      [](const Law& law, const Setup& setup, int repeats) {
        const py::gil_scoped_release release;
        return time_loop(setup, law, repeats);
      },
      py::arg("setup"), py::arg("repeats"));
}

}  // namespace ebac::python
