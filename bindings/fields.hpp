#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "ebac/core/check.hpp"
#include "values.hpp"

/// Python classes made from field lists: the one list gives names, units, ranges, errors and
/// documentation. All of it is compiled once, over `FieldTable`; a type adds its constructor.
namespace ebac::python {

/// One entry of a field list, as Python sees it.
struct FieldInfo {
  std::string name, unit, meaning, kind;
  py::object initial;
  double low, high;
};

/// "rated torque [N m], 1e-05 to 1000"
std::string describe(const FieldRow& field);

py::object value_of(const FieldRow& field, const void* owner);
Values values_of(const FieldTable& table, const void* owner);
template <Described T>
Values values_of(const T& owner) {
  return values_of(field_table<T>(), &owner);
}

using Units = py::typing::Dict<py::str, py::str>;

/// Units of the fields by their names; a pure number has none.
Units units_of(const FieldTable& table);
template <Described T>
Units units_of() {
  return units_of(field_table<T>());
}

/// Sets the field `name` of `target`; false when it has none of that name.
bool set_field(const FieldTable& table, void* target, const std::string& owner,
               const std::string& name, py::handle value);

std::vector<std::string> field_names(const FieldTable& table);

/// Refuses an unknown keyword, with the nearest known one.
[[noreturn]] void refuse_keyword(const std::string& owner, const std::string& name,
                                 const std::vector<std::string>& known);
/// Refuses values without a name.
void refuse_positional(const std::string& owner, const py::args& args,
                       const std::vector<std::string>& known);

/// Takes the part `name` out of `given` into `part`, where it is given; `kind` says what it must be.
template <class Part>
void take_part(py::dict& given, const std::string& owner, const char* name, Part& part,
               const char* kind) {
  if (!given.contains(name)) return;
  const py::object value = given.attr("pop")(name);
  try {
    part = value.cast<Part>();
  } catch (const py::cast_error&) {
    throw py::type_error(owner + "." + name + " = " + py::cast<std::string>(py::repr(value)) +
                         ": must be " + kind);
  }
}
/// Refuses the keywords that are left over.
void refuse_rest(const std::string& owner, const py::dict& given,
                 const std::vector<std::string>& known);

/// Sets fields from keywords.
void set_fields(const FieldTable& table, void* target, const std::string& owner,
                const py::args& args, const py::kwargs& given);

/// ", damping: float = 2.0" for every field, for a signature in a docstring.
std::string signature(const FieldTable& table);
/// What `inspect.signature` shows: keywords with their defaults; `more` are (name, default), where
/// `inspect.Parameter.empty` is none.
void add_signature(const py::object& cls, const FieldTable& table,
                   const std::vector<std::pair<std::string, py::object>>& more = {});

/// "Parameters\n----------\ndamping : float\n    ..." for a class docstring.
std::string parameter_table(const FieldTable& table);

/// Where the fields of a Python object lie.
using Place = const void* (*)(py::handle self);

template <class T>
const void* place_of(py::handle self) {
  return self.cast<const T*>();
}

/// Read-only properties, `fields()` and `as_dict()`.
void add_members(const py::object& cls, const FieldTable& table, Place place);
void add_as_dict(const py::object& cls, const FieldTable& table, Place place, const char* what);

/// A constructor from `make(args, kwargs)`, under the signature it really has.
template <class Class, class Make>
void def_init(Class& cls, Make make, const std::string& signature) {
  const OwnSignatures own;
  cls.def(py::init(std::move(make)), signature.c_str());
}

/// A frozen, keyword-only Python class from the field list of T.
template <Described T>
py::class_<T> bind_fields(py::module_& m, const char* name, const std::string& doc) {
  const FieldTable& table = field_table<T>();
  py::class_<T> cls(m, name, (doc + parameter_table(table)).c_str());
  const std::string owner = name;
  def_init(
      cls,
      [owner](const py::args& args, const py::kwargs& given) {
        T value{};
        set_fields(field_table<T>(), &value, owner, args, given);
        check_fields(field_table<T>(), &value, owner);
        return value;
      },
      table.rows.empty() ? "__init__(self) -> None"
                         : "__init__(self, *" + signature(table) + ") -> None");
  add_members(cls, table, &place_of<T>);
  add_as_dict(cls, table, &place_of<T>, "Return the parameters by name.");
  add_value_methods(cls);
  add_signature(cls, table);
  return cls;
}

}  // namespace ebac::python
