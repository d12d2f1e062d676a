#include "values.hpp"

#include <cmath>

namespace ebac::python {

py::object rebuild(const py::object& cls, const Values& values) { return cls(**values); }

std::string represent(const py::object& self) {
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

void add_value_methods(const py::object& cls) {
  add_method(cls, "__repr__", &represent, "__repr__(self) -> str");
  add_method(
      cls, "__eq__",
      [](const py::object& self, const py::object& other) -> py::object {
        if (!py::type::of(self).is(py::type::of(other))) {
          return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        }
        return py::bool_(self.attr("as_dict")().equal(other.attr("as_dict")()));
      },
      "__eq__(self, other: object) -> bool");
  add_method(
      cls, "__hash__", [](const py::object& self) { return py::hash(py::str(represent(self))); },
      "__hash__(self) -> int");
  add_method(
      cls, "__reduce__",
      [](const py::object& self) {
        const py::object rebuild_function = py::module_::import("ebac._core").attr("_rebuild");
        return py::make_tuple(rebuild_function,
                              py::make_tuple(py::type::of(self), self.attr("as_dict")()));
      },
      "__reduce__(self) -> tuple[typing.Any, ...]");
  add_method(
      cls, "replace",
      [](const py::object& self, const py::kwargs& changes) {
        py::dict values = self.attr("as_dict")();
        for (const auto& [name, value] : changes) values[name] = value;
        return py::type::of(self)(**values);
      },
      "replace(self, **changes: typing.Any) -> typing.Self\n\n"
      "Return a copy with some parameters changed, checked as at construction.");
}

void add_property(const py::object& cls, const std::string& name, const py::cpp_function& get,
                  const std::string& doc) {
  const auto property =
      py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&PyProperty_Type));
  py::setattr(cls, name.c_str(), property(get, py::none(), py::none(), py::str(doc)));
}

}  // namespace ebac::python
