#include "controllers.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <variant>

#include "bind.hpp"
#include "ebac/control/law_types.hpp"
#include "ebac/model/device.hpp"
#include "fields.hpp"
#include "law_class.hpp"

namespace ebac::python {

namespace {

/// Parameters or state of a law whose type is known at run time only.
class Block {
 public:
  Block(const FieldTable& table, const void* from) : words_((table.size + 7) / 8) {
    std::memcpy(data(), from, table.size);
  }
  void* data() { return words_.data(); }
  const void* data() const { return words_.data(); }

 private:
  std::vector<std::uint64_t> words_;
};

struct LawState {
  const LawType* type;
  Block values;
};

const void* params_at(py::handle self) { return self.cast<const AnyLaw&>().params(); }
const void* state_at(py::handle self) { return self.cast<const LawState&>().values.data(); }

std::vector<std::string> parameter_names(const LawType& type) {
  std::vector<std::string> names = field_names(type.params);
  names.emplace_back("timing");
  return names;
}

AnyLaw make_law(const LawType& type, const std::string& owner, Block params, Timing timing,
                const py::kwargs& given) {
  for (const auto& [key, item] : given) {
    const auto word = py::cast<std::string>(key);
    if (word == "timing") {
      if (!py::isinstance<Timing>(item)) {
        throw py::type_error(owner + ".timing = " + py::cast<std::string>(py::repr(item)) +
                             ": must be a Timing");
      }
      timing = item.cast<Timing>();
    } else if (!set_field(type.params, params.data(), owner, word, item)) {
      refuse_keyword(owner, word, parameter_names(type));
    }
  }
  check_fields(type.params, params.data(), owner);
  return type.make(params.data(), timing);
}

/// A subclass of `base` without members of its own, in `scope`.
py::object subclass(const py::object& base, const py::object& scope, const char* name,
                    const std::string& doc) {
  py::dict members;
  members["__slots__"] = py::tuple();
  members["__doc__"] = doc;
  const bool nested = PyType_Check(scope.ptr());
  members["__module__"] = scope.attr(nested ? "__module__" : "__name__");
  if (nested) members["__qualname__"] = py::str("{}.{}").format(scope.attr("__qualname__"), name);
  const py::object cls = py::type::of(base)(name, py::make_tuple(base), members);
  py::setattr(scope, name, cls);
  return cls;
}

py::object core() { return py::module_::import("ebac._core"); }

py::object bind_state(const LawClass& law) {
  py::object cls = subclass(core().attr("_LawState"), law.cls, "State",
                            "State of the law, recorded in a trace.");
  add_members(cls, law.type->state, &state_at);
  add_as_dict(cls, law.type->state, &state_at, "Return the values by name.");
  add_method(cls, "__repr__", &represent, "__repr__(self: object) -> str\n");
  return cls;
}

/// A Python object of the law's class.
py::object instance(const py::object& cls, AnyLaw law) {
  return cls(py::capsule(static_cast<const void*>(&law)));
}

void bind_init(const LawClass& law) {
  const auto init = [type = law.type, owner = law.owner](py::detail::value_and_holder& self,
                                                         const py::args& args,
                                                         const py::kwargs& given) {
    if (args.size() == 1 && py::isinstance<py::capsule>(args[0])) {
      const auto made = py::reinterpret_borrow<py::capsule>(args[0]);
      self.value_ptr() = new AnyLaw(*made.get_pointer<const AnyLaw>());
      return;
    }
    refuse_positional(owner, args, parameter_names(*type));
    self.value_ptr() = new AnyLaw(
        make_law(*type, owner, Block(type->params, type->params.initial), Timing{}, given));
  };
  law.def("__init__", init,
          "(self, *" + signature(law.type->params) + ", timing: Timing = ...) -> None", "",
          py::detail::is_new_style_constructor());
  add_signature(law.cls, law.type->params, {{"timing", py::cast(Timing{})}});
}

/// `design(facts, timing, **changes)`, from the facts or from the device that has them.
void bind_design(const LawClass& law) {
  const auto facts_of = [owner = law.owner](py::handle given) {
    if (py::isinstance<DeviceModel>(given)) return given.cast<const DeviceModel&>().facts();
    if (py::isinstance<DeviceFacts>(given)) return given.cast<DeviceFacts>();
    throw py::type_error(owner + ".design: facts = " + py::cast<std::string>(py::repr(given)) +
                         ": must be a Device or DeviceFacts");
  };
  const auto design = [type = law.type, owner = law.owner, cls = law.cls, facts_of](
                          const py::object& given, const py::object& time,
                          const py::kwargs& changes) {
    const DeviceFacts facts = facts_of(given);
    if (!py::isinstance<Timing>(time)) {
      throw py::type_error(owner + ".design: timing = " + py::cast<std::string>(py::repr(time)) +
                           ": must be a Timing");
    }
    const auto timing = time.cast<Timing>();
    Block params(type->params, type->params.initial);
    type->design(params.data(), facts, timing);
    return instance(cls, make_law(*type, owner, std::move(params), timing, changes));
  };
  law.def_static(
      "design", design,
      "(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> " + law.owner,
      "Design the law for a device from facts about it; `changes` override parameters.",
      py::arg("facts"), py::arg("timing"));
}

void bind_values(const LawClass& law, const py::object& state) {
  add_members(law.cls, law.type->params, &params_at);
  const std::string self = "(arg0: " + law.full + ") -> ";
  const OwnSignatures own;
  add_property(law.cls, "timing",
               py::cpp_function([](const AnyLaw& any) { return any.timing(); },
                                py::is_method(law.cls), (self + "ebac._core.Timing\n").c_str()),
               "Sample time and delay for which the law is designed.");
  add_property(law.cls, "state",
               py::cpp_function([state](const py::object& any) { return state(any); },
                                py::is_method(law.cls), (self + law.full + ".State\n").c_str()),
               "State of the law after the last step.");
  law.def(
      "as_dict",
      [](const AnyLaw& any) {
        Values values = values_of(any.type().params, any.params());
        values["timing"] = any.timing();
        return values;
      },
      "(self: LAW) -> dict[str, object]", "Return the parameters by name, without the state.");
  add_value_methods(law.cls);
}

void bind_steps(const LawClass& law) {
  law.def(
      "step",
      [](AnyLaw& any, const py::object& port) {
        if (!py::isinstance<Port>(port)) {
          throw py::type_error(
              py::cast<std::string>(py::str("step: port = {!r}: must be a Port").format(port)));
        }
        return any.step(port.cast<const Port&>());
      },
      "(self: LAW, port: ebac._core.Port) -> float",
      "Compute one tick of one axis; return the commanded force [N].", py::arg("port"));
  law.def(
      "reset", [](AnyLaw& any) { any.reset(); }, "(self: LAW) -> None",
      "Reset the state; the parameters stay.");
  law.def(
      "copy",
      [cls = law.cls](const py::object& self) {
        return instance(py::type::of(self), self.cast<const AnyLaw&>());
      },
      "(self: LAW) -> LAW", "Return an independent copy, state included.");
  law.cls.attr("name") = std::string(law.type->name);
  law.cls.attr("summary") = std::string(law.type->summary);
  law.cls.attr("passive") = law.type->passive;
}

/// Binds one law: class, state, design, stepping, simulation and benchmark.
void bind_law(const py::module_& m, const char* name, const LawType& type) {
  const LawClass law{
      .cls = subclass(core().attr("_Law"), m, name,
                      std::string(type.summary) + "." + parameter_table(type.params)),
      .type = &type,
      .owner = name,
      .full = py::cast<std::string>(m.attr("__name__")) + "." + name};
  const py::object state = bind_state(law);
  bind_init(law);
  bind_design(law);
  bind_values(law, state);
  bind_steps(law);
  add_runs(law);
  add_start(law);
}

void refuse_other_headers(const py::module_& module, const std::string& compiled) {
  if (compiled == compiled_with()) return;
  throw py::import_error(
      py::cast<std::string>(module.attr("__name__")) + " is compiled with headers of ebac " +
      compiled + ", this ebac with headers of " + compiled_with() +
      ": install the core and the package from the same clone, then compile the module "
      "again (docs/how-to/write_a_law.md)");
}

void bind_bases(py::module_& m) {
  const OwnSignatures own;
  py::class_<LawState>(m, "_LawState", "State of any law.")
      .def(py::init([](const py::args& args, const py::kwargs&) {
             if (args.size() != 1 || !py::isinstance<AnyLaw>(args[0])) {
               throw py::type_error("State: nobody makes one; it is `state` of a law");
             }
             const auto& law = args[0].cast<const AnyLaw&>();
             return LawState{&law.type(), Block(law.type().state, law.state())};
           }),
           "State of a law.");
  const py::class_<AnyLaw> laws(m, "_Law", "Base class of the control laws.");
}

}  // namespace

std::string LawClass::documented(const char* name, const std::string& signature,
                                 const char* what) const {
  std::string text = name + signature + "\n";
  if (*what != '\0') text += std::string("\n") + what + "\n";
  for (std::size_t at = text.find("LAW"); at != std::string::npos; at = text.find("LAW", at)) {
    text.replace(at, 3, full);
    at += full.size();
  }
  return text;
}

/// A new law: its header in control/laws.hpp, one line here.
void bind_controllers(py::module_& m) {
  bind_bases(m);
  m.def("_bind_law", [](const py::module_& module, const char* name, const std::string& compiled,
                        const py::capsule& type) {
    refuse_other_headers(module, compiled);
    bind_law(module, name, *type.get_pointer<const LawType>());
  });
  constexpr std::array<std::array<const char*, 2>, 13> kLaws{
      {{"Direct", "direct"},
       {"TCA", "tca"},
       {"TCADamped", "tca-damped"},
       {"LagCompensator", "lag-compensator"},
       {"PassivityControl", "passivity-control"},
       {"ISS", "iss"},
       {"VirtualCoupling", "virtual-coupling"},
       {"SFA", "sfa"},
       {"ForceBounding", "force-bounding"},
       {"EBA", "eba"},
       {"EBAAccount", "eba-account"},
       {"EBACPrinted", "ebac-printed"},
       {"EBAC", "ebac"}}};
  for (const auto& [cls, name] : kLaws) bind_law(m, cls, law_named(name));
}

}  // namespace ebac::python
