#pragma once

#include <pybind11/pybind11.h>

#include <string>

/// Python manners of a value: what every parameter class has, derived from `as_dict` alone.
namespace ebac::python {

namespace py = pybind11;

inline py::object rebuild(const py::object& cls, const py::dict& values) { return cls(**values); }

/// "Motor(torque_constant=0.0538, ...)": evaluates to an equal value.
inline std::string represent(const py::object& self) {
  std::string text = py::cast<std::string>(py::type::of(self).attr("__name__")) + "(";
  const char* between = "";
  for (const auto& [name, value] : self.attr("as_dict")().cast<py::dict>()) {
    text += between + py::cast<std::string>(name) + "=" + py::cast<std::string>(py::repr(value));
    between = ", ";
  }
  return text + ")";
}

template <class Class>
Class& add_value_methods(Class& cls) {
  cls.def("__repr__", &represent)
      .def("__eq__",
           [](const py::object& self, const py::object& other) -> py::object {
             if (!py::type::of(self).is(py::type::of(other))) {
               return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             }
             return py::bool_(self.attr("as_dict")().equal(other.attr("as_dict")()));
           },
           "__eq__(self, other: object) -> bool")
      .def("__hash__", [](const py::object& self) { return py::hash(py::str(represent(self))); })
      .def("__reduce__",
           [](const py::object& self) {
             const py::object rebuild_function = py::module_::import("ebac._core").attr("_rebuild");
             return py::make_tuple(rebuild_function,
                                   py::make_tuple(py::type::of(self), self.attr("as_dict")()));
           },
           "__reduce__(self) -> tuple[typing.Any, ...]")
      .def("replace",
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
