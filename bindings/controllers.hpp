#pragma once

#include <memory>
#include <string>

#include "ebac/sim/benchmark.hpp"
#include "ebac/sim/simulate.hpp"
#include "fields.hpp"

/// The Python class of a law, written once for all of them.
namespace ebac::python {

template <Controller Law>
Law make_law(const std::string& owner, typename Law::Params params, Timing timing, const py::kwargs& given) {
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
  cls.def("as_dict", &values_of<State>, "as_dict(self) -> dict[str, typing.Any]\n\nValues by name.");
  cls.def("__repr__", &represent);
}

/// Binds one law: class, state, design, stepping, simulation and benchmark.
template <Controller Law>
void bind_controller(py::module_& m, const char* name) {
  using Params = typename Law::Params;
  const std::string owner = name;
  const std::string keywords = signature(Params{}) + ", timing: Timing = ...";
  py::class_<Law> cls(m, name, (std::string(Law::kSummary) + "." + parameter_table<Params>()).c_str());
  bind_state<typename Law::State>(cls);

  cls.def(py::init([owner](const py::kwargs& given) { return make_law<Law>(owner, Params{}, Timing{}, given); }),
          ("__init__(self, *" + keywords + ") -> None").c_str());
  const std::string design_doc =
      " -> " + owner + "\n\nThe law for a device: every parameter from what a user can know of it, changes on top.";
  cls.def_static(
      "design",
      [owner](const DeviceFacts& facts, const Timing& timing, const py::kwargs& changes) {
        return make_law<Law>(owner, Params::design(facts, timing), timing, changes);
      },
      ("design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any)" + design_doc).c_str());
  cls.def_static("design", [owner](const DeviceModel& device, const Timing& timing, const py::kwargs& changes) {
    return make_law<Law>(owner, Params::design(device.facts(), timing), timing, changes);
  });
  add_members<Params>(cls, [](const Law& law) -> const Params& { return law.params(); });
  cls.def_property_readonly("timing", &Law::timing, "Sample time and delay the law counts with.");
  cls.def_property_readonly(
      "state", [](const Law& law) { return law.state(); }, "What the law remembers, as of the last step.");
  cls.def("as_dict",
          [](const Law& law) {
            py::dict values = values_of(law.params());
            values["timing"] = law.timing();
            return values;
          },
          "as_dict(self) -> dict[str, typing.Any]\n\nParameters by name; not the state.");
  add_value_methods(cls);
  cls.def("step", &Law::step, "step(self, port: Port) -> float\n\nOne tick of one axis: the force it commands [N].");
  cls.def("reset", &Law::reset, "reset(self) -> None\n\nForgets everything but its parameters.");
  cls.def("copy", [](const Law& law) { return law; },
          ("copy(self) -> " + owner + "\n\nAn independent copy, state included.").c_str());
  cls.attr("name") = std::string(Law::kName);
  cls.attr("summary") = std::string(Law::kSummary);
  cls.attr("passive") = Law::kPassive;

  m.def("_simulate", [](const Setup& setup, const Law& law) {
    const py::gil_scoped_release release;
    return simulate(setup, law);
  });
  m.def("_time_law", [](const Setup& setup, const Law& law, int repeats) {
    const py::gil_scoped_release release;
    return time_law(setup, law, repeats);
  });
  m.def("_time_loop", [](const Setup& setup, const Law& law, int repeats) {
    const py::gil_scoped_release release;
    return time_loop(setup, law, repeats);
  });
}

}  // namespace ebac::python
