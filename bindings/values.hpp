#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <cmath>
#include <string>

/// Python manners of a value: what every parameter class has, derived from `as_dict` alone.
namespace ebac::python {

namespace py = pybind11;

/// While it lives, a docstring that starts with a signature replaces the one pybind11 would write:
/// for functions that take **kwargs and know better.
class OwnSignatures {
 public:
  OwnSignatures() { options_.disable_function_signatures(); }

 private:
  py::options options_;
};

/// A constructor from `make(kwargs)`, under the signature it really has.
template <class Class, class Make>
void def_init(Class& cls, Make make, const std::string& signature) {
  const OwnSignatures own;
  cls.def(py::init(std::move(make)), signature.c_str());
}

using Values = py::typing::Dict<py::str, py::object>;

inline py::object rebuild(const py::object& cls, const Values& values) { return cls(**values); }

/// "Motor(torque_constant=0.0538, ...)": evaluates to an equal value.
inline std::string represent(const py::object& self) {
  std::string text = py::cast<std::string>(py::type::of(self).attr("__name__")) + "(";
  const char* between = "";
  for (const auto& [name, value] : self.attr("as_dict")().cast<py::dict>()) {
    auto shown = py::cast<std::string>(py::repr(value));
    if (py::isinstance<py::float_>(value) && !std::isfinite(value.cast<double>()))
      shown.insert(0, "float('").append("')");
    text.append(between).append(py::cast<std::string>(name)).append("=").append(shown);
    between = ", ";
  }
  return text + ")";
}

template <class Class>
Class& add_value_methods(Class& cls) {
  const OwnSignatures own;
  cls.def("__repr__", &represent, "__repr__(self) -> str")
      .def(
          "__eq__",
          [](const py::object& self, const py::object& other) -> py::object {
            if (!py::type::of(self).is(py::type::of(other))) {
              return py::reinterpret_borrow<py::object>(Py_NotImplemented);
            }
            return py::bool_(self.attr("as_dict")().equal(other.attr("as_dict")()));
          },
          "__eq__(self, other: object) -> bool")
      .def(
          "__hash__", [](const py::object& self) { return py::hash(py::str(represent(self))); },
          "__hash__(self) -> int")
      .def(
          "__reduce__",
          [](const py::object& self) {
            const py::object rebuild_function = py::module_::import("ebac._core").attr("_rebuild");
            return py::make_tuple(rebuild_function,
                                  py::make_tuple(py::type::of(self), self.attr("as_dict")()));
          },
          "__reduce__(self) -> tuple[typing.Any, ...]")
      .def(
          "replace",
          [](const py::object& self, const py::kwargs& changes) {
            py::dict values = self.attr("as_dict")();
            for (const auto& [name, value] : changes) values[name] = value;
            return py::type::of(self)(**values);
          },
          "replace(self, **changes: typing.Any) -> typing.Self\n\n"
          "A copy with some parameters changed; checked as at construction.");
  return cls;
}

}  // namespace ebac::python
