#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

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

using Values = py::typing::Dict<py::str, py::object>;

/// What unpickling calls.
py::object rebuild(const py::object& cls, const Values& values);

/// "Motor(torque_constant=0.0538, ...)": evaluates to an equal value.
std::string represent(const py::object& self);

/// Adds repr, equality, hash, pickling and `replace` to a class that has `as_dict`.
void add_value_methods(const py::object& cls);

/// Adds a method, or a function of the class, under a docstring that begins with its signature.
template <class Function, class... Extra>
void add_method(const py::object& cls, const char* name, Function function, const std::string& doc,
                const Extra&... extra) {
  const OwnSignatures own;
  py::setattr(cls, name,
              py::cpp_function(std::move(function), py::name(name), py::is_method(cls), doc.c_str(),
                               extra...));
}
template <class Function, class... Extra>
void add_static(const py::object& cls, const char* name, Function function, const std::string& doc,
                const Extra&... extra) {
  const OwnSignatures own;
  py::setattr(cls, name,
              py::staticmethod(py::cpp_function(std::move(function), py::name(name), py::scope(cls),
                                                doc.c_str(), extra...)));
}

/// A read-only property of `type`, as a stub writes it.
void add_property(const py::object& cls, const std::string& name, const py::cpp_function& get,
                  const std::string& doc);

}  // namespace ebac::python
