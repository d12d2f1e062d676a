#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <string>
#include <vector>

#include "ebac/core/check.hpp"
#include "values.hpp"

/// Python classes made from field lists: the one list gives names, units, ranges, errors and
/// documentation.
namespace ebac::python {

/// One entry of a field list, as Python sees it.
struct FieldInfo {
  std::string name, unit, meaning, kind;
  py::object initial;
  double low, high;
};

template <class Value>
constexpr const char* python_type() {
  if constexpr (std::is_same_v<Value, double>) return "float";
  if constexpr (std::is_same_v<Value, bool>) return "bool";
  if constexpr (std::is_same_v<Value, Fault>) return "Fault";
  return "int";
}

/// "rated torque [N m], 1e-05 to 1000"
template <class T>
std::string describe(const Field<T>& field) {
  std::string text(field.meaning);
  if (field.unit != "1") text += " [" + std::string(field.unit) + "]";
  const bool low = std::isfinite(field.low);
  const bool high = std::isfinite(field.high);
  if (low && high) text += ", " + shortest(field.low) + " to " + shortest(field.high);
  if (low && !high) text += ", at least " + shortest(field.low);
  return text;
}

template <Described T>
std::vector<FieldInfo> field_infos() {
  std::vector<FieldInfo> all;
  const T initial{};
  for (const auto& field : T::fields()) {
    std::visit(
        [&](auto member) {
          using Value = std::remove_cvref_t<decltype(initial.*member)>;
          all.push_back({std::string(field.name), std::string(field.unit),
                         std::string(field.meaning), python_type<Value>(),
                         py::cast(initial.*member), field.low, field.high});
        },
        field.member);
  }
  return all;
}

/// Sets the field `name` of `target`; false when it has none of that name.
template <Described T>
bool set_field(T& target, const std::string& owner, const std::string& name, py::handle value) {
  for (const auto& field : T::fields()) {
    if (field.name != name) continue;
    std::visit(
        [&](auto member) {
          using Value = std::remove_cvref_t<decltype(target.*member)>;
          try {
            if (std::is_same_v<Value, bool> && !py::isinstance<py::bool_>(value)) {
              throw py::cast_error();
            }
            target.*member = value.cast<Value>();
          } catch (const py::cast_error&) {
            if (std::is_same_v<Value, int> &&
                py::isinstance<py::int_>(value)) {  // too large for an int
              throw std::invalid_argument(range_message(owner, name, value.cast<double>(),
                                                        field.unit, field.low, field.high));
            }
            throw py::type_error(
                owner + "." + name + " = " + py::cast<std::string>(py::repr(value)) + ": must be " +
                python_type<Value>() + (field.unit == "1" ? "" : " in " + std::string(field.unit)));
          }
        },
        field.member);
    return true;
  }
  return false;
}

/// Refuses a keyword nobody knows, naming the nearest that exists.
[[noreturn]] inline void refuse_keyword(const std::string& owner, const std::string& name,
                                        const std::vector<std::string>& known) {
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(name, known, 1);
  std::string text = owner + " has no parameter '" + name + "'";
  if (!near.empty()) text += ", did you mean '" + py::cast<std::string>(near[0]) + "'";
  text += "; it has: ";
  for (const std::string& one : known) text.append(&one == known.data() ? "" : ", ").append(one);
  throw py::type_error(text);
}

template <Described T>
std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const auto& field : T::fields()) names.emplace_back(field.name);
  return names;
}

/// ", damping: float = 2.0" for every field, for a signature in a docstring.
template <Described T>
std::string signature(const T& initial) {
  std::string text;
  for (const auto& field : T::fields()) {
    std::visit(
        [&](auto member) {
          using Value = std::remove_cvref_t<decltype(initial.*member)>;
          std::string value = "...";
          const auto as_double = static_cast<double>(initial.*member);
          if (std::isfinite(as_double))
            value = py::cast<std::string>(py::repr(py::cast(initial.*member)));
          text += ", " + std::string(field.name) + ": " + python_type<Value>() + " = " + value;
        },
        field.member);
  }
  return text;
}

/// "Parameters\n----------\ndamping : float\n    ..." for a class docstring.
template <Described T>
std::string parameter_table() {
  std::string text;
  const T initial{};
  for (const auto& field : T::fields()) {
    std::visit(
        [&](auto member) {
          using Value = std::remove_cvref_t<decltype(initial.*member)>;
          text += std::string(field.name) + " : " + python_type<Value>() + "\n    " +
                  describe(field) + ".\n";
        },
        field.member);
  }
  return text.empty() ? text : "\n\nParameters\n----------\n" + text;
}

template <Described T>
Values values_of(const T& value) {
  Values values;
  for (const auto& field : T::fields()) {
    std::visit([&](auto member) { values[py::str(std::string(field.name))] = value.*member; },
               field.member);
  }
  return values;
}

/// Read-only properties, `fields()` and `as_dict()`.
template <Described T, class Class, class Get>
void add_members(Class& cls, Get get) {
  using Self = Class::type;
  for (const auto& field : T::fields()) {
    std::visit(
        [&](auto member) {
          cls.def_property_readonly(
              std::string(field.name).c_str(),
              [get, member](const Self& self) { return get(self).*member; },
              describe(field).c_str());
        },
        field.member);
  }
  cls.def_static("fields", &field_infos<T>,
                 "Name, unit, meaning, default and range of every parameter.");
}

/// A frozen, keyword-only Python class from the field list of T.
template <Described T>
py::class_<T> bind_fields(py::module_& m, const char* name, const std::string& doc) {
  py::class_<T> cls(m, name, (doc + parameter_table<T>()).c_str());
  const std::string owner = name;
  def_init(
      cls,
      [owner](const py::kwargs& given) {
        T value{};
        for (const auto& [key, item] : given) {
          const auto word = py::cast<std::string>(key);
          if (!set_field(value, owner, word, item)) refuse_keyword(owner, word, field_names<T>());
        }
        check(value, owner);
        return value;
      },
      field_names<T>().empty() ? "__init__(self) -> None"
                               : "__init__(self, *" + signature(T{}) + ") -> None");
  add_members<T>(cls, [](const T& self) -> const T& { return self; });
  cls.def("as_dict", &values_of<T>, "Parameters by name.");
  add_value_methods(cls);
  return cls;
}

}  // namespace ebac::python
