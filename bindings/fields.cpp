#include "fields.hpp"

#include <cmath>
#include <limits>

#include "ebac/core/sample.hpp"

namespace ebac::python {

namespace {

const char* python_type(FieldKind kind) {
  switch (kind) {
    case FieldKind::kDouble:
      return "float";
    case FieldKind::kBool:
      return "bool";
    case FieldKind::kFault:
      return "Fault";
    case FieldKind::kInt:
    case FieldKind::kInt64:
      break;
  }
  return "int";
}

/// The same in the words of a message.
const char* plain_type(FieldKind kind) {
  if (kind == FieldKind::kDouble) return "a number";
  return kind == FieldKind::kInt ? "a whole number" : python_type(kind);
}

void assign(const FieldRow& field, void* target, py::handle value) {
  // Python takes True for 1.
  const bool truth = py::isinstance<py::bool_>(value);
  if (truth != (field.kind == FieldKind::kBool)) throw py::cast_error();
  switch (field.kind) {
    case FieldKind::kDouble:
      field.in<double>(target) = value.cast<double>();
      return;
    case FieldKind::kInt64:
      field.in<std::int64_t>(target) = value.cast<std::int64_t>();
      return;
    case FieldKind::kInt:
      field.in<int>(target) = value.cast<int>();
      return;
    case FieldKind::kFault:
      field.in<Fault>(target) = value.cast<Fault>();
      return;
    case FieldKind::kBool:
      field.in<bool>(target) = value.cast<bool>();
  }
}

/// A whole number as a double; one beyond them is infinite.
double nearest_double(py::handle whole) {
  const double value = PyLong_AsDouble(whole.ptr());
  if (PyErr_Occurred() == nullptr) return value;
  PyErr_Clear();
  const bool negative = whole < py::int_(0);
  return std::copysign(std::numeric_limits<double>::infinity(), negative ? -1.0 : 1.0);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& one : names) text.append(text.empty() ? "" : ", ").append(one);
  return text;
}

/// "ebac._core.Motor"
std::string full_name(const py::object& cls) {
  return py::cast<std::string>(cls.attr("__module__")) + "." +
         py::cast<std::string>(cls.attr("__qualname__"));
}

std::vector<FieldInfo> field_infos(const FieldTable& table) {
  std::vector<FieldInfo> all;
  for (const FieldRow& field : table.rows) {
    all.push_back({std::string(field.name), std::string(field.unit), std::string(field.meaning),
                   python_type(field.kind), value_of(field, table.initial), field.low, field.high});
  }
  return all;
}

}  // namespace

std::string describe(const FieldRow& field) {
  std::string text(field.meaning);
  if (field.unit != "1") text += " [" + std::string(field.unit) + "]";
  const bool low = std::isfinite(field.low);
  const bool high = std::isfinite(field.high);
  if (low && high) text += ", " + shortest(field.low) + " to " + shortest(field.high);
  if (low && !high) text += ", at least " + shortest(field.low);
  return text;
}

py::object value_of(const FieldRow& field, const void* owner) {
  switch (field.kind) {
    case FieldKind::kDouble:
      return py::float_(field.in<double>(owner));
    case FieldKind::kInt64:
      return py::int_(field.in<std::int64_t>(owner));
    case FieldKind::kInt:
      return py::int_(field.in<int>(owner));
    case FieldKind::kFault:
      return py::cast(field.in<Fault>(owner));
    case FieldKind::kBool:
      return py::bool_(field.in<bool>(owner));
  }
  return py::none();
}

Values values_of(const FieldTable& table, const void* owner) {
  Values values;
  for (const FieldRow& field : table.rows) {
    values[py::str(std::string(field.name))] = value_of(field, owner);
  }
  return values;
}

Units units_of(const FieldTable& table) {
  Units units;
  for (const FieldRow& field : table.rows) {
    if (field.unit != "1") units[py::str(std::string(field.name))] = std::string(field.unit);
  }
  return units;
}

bool set_field(const FieldTable& table, void* target, const std::string& owner,
               const std::string& name, py::handle value) {
  const FieldRow* field = table.find(name);
  if (field == nullptr) return false;
  try {
    assign(*field, target, value);
  } catch (const py::cast_error&) {
    const bool whole = py::isinstance<py::int_>(value) && !py::isinstance<py::bool_>(value);
    const bool numeric = field->kind == FieldKind::kInt || field->kind == FieldKind::kInt64 ||
                         field->kind == FieldKind::kDouble;
    if (whole && numeric) {  // too large
      throw std::invalid_argument(
          range_message(owner, name, nearest_double(value), field->unit, field->low, field->high));
    }
    throw py::type_error(owner + "." + name + " = " + py::cast<std::string>(py::repr(value)) +
                         ": must be " + plain_type(field->kind) +
                         (field->unit == "1" ? "" : " in " + std::string(field->unit)));
  }
  return true;
}

std::vector<std::string> field_names(const FieldTable& table) {
  std::vector<std::string> names;
  for (const FieldRow& field : table.rows) names.emplace_back(field.name);
  return names;
}

void refuse_keyword(const std::string& owner, const std::string& name,
                    const std::vector<std::string>& known) {
  if (known.empty()) throw py::type_error(owner + " has no parameter '" + name + "'; it has none");
  py::dict given;
  given[py::str(name)] = py::none();
  py::module_::import("ebac._util.arguments").attr("refuse_unknown")(owner, given, known);
  throw py::type_error(owner + ": unexpected keyword argument '" + name + "'");
}

void refuse_positional(const std::string& owner, const py::args& args,
                       const std::vector<std::string>& known) {
  if (args.empty()) return;
  const auto value = py::cast<std::string>(py::repr(args[0]));
  if (known.empty()) throw py::type_error(owner + "(" + value + "): takes no parameters");
  throw py::type_error(owner + "(" + value + "): takes parameters by name only, as in " + owner +
                       "(" + known[0] + "=" + value + "); it has: " + listed(known));
}

void refuse_rest(const std::string& owner, const py::dict& given,
                 const std::vector<std::string>& known) {
  for (const auto& [key, value] : given) {
    refuse_keyword(owner, py::cast<std::string>(key), known);
  }
}

void set_fields(const FieldTable& table, void* target, const std::string& owner,
                const py::args& args, const py::kwargs& given) {
  refuse_positional(owner, args, field_names(table));
  for (const auto& [key, item] : given) {
    const auto word = py::cast<std::string>(key);
    if (!set_field(table, target, owner, word, item)) {
      refuse_keyword(owner, word, field_names(table));
    }
  }
}

std::string signature(const FieldTable& table) {
  std::string text;
  for (const FieldRow& field : table.rows) {
    const bool shown = std::isfinite(field.number(table.initial));
    const std::string value =
        shown ? py::cast<std::string>(py::repr(value_of(field, table.initial))) : "...";
    text += ", " + std::string(field.name) + ": " + python_type(field.kind) + " = " + value;
  }
  return text;
}

void add_signature(const py::object& cls, const FieldTable& table,
                   const std::vector<std::pair<std::string, py::object>>& more) {
  using namespace py::literals;
  const auto inspect = py::module_::import("inspect");
  const py::object parameter = inspect.attr("Parameter");
  const py::object keyword = parameter.attr("KEYWORD_ONLY");
  py::list parameters;
  for (const FieldRow& field : table.rows) {
    parameters.append(parameter(std::string(field.name), keyword,
                                "default"_a = value_of(field, table.initial),
                                "annotation"_a = python_type(field.kind)));
  }
  for (const auto& [name, initial] : more) {
    parameters.append(parameter(name, keyword, "default"_a = initial));
  }
  py::setattr(cls, "__signature__", inspect.attr("Signature")(parameters));
}

std::string parameter_table(const FieldTable& table) {
  std::string text;
  for (const FieldRow& field : table.rows) {
    text += std::string(field.name) + " : " + python_type(field.kind) + "\n    " + describe(field) +
            ".\n";
  }
  return text.empty() ? text : "\n\nParameters\n----------\n" + text;
}

void add_members(const py::object& cls, const FieldTable& table, Place place) {
  const OwnSignatures own;
  const std::string self = "(arg0: " + full_name(cls) + ") -> ";
  for (const FieldRow& field : table.rows) {
    const py::cpp_function get(
        [place, row = &field](py::handle object) { return value_of(*row, place(object)); },
        py::is_method(cls), (self + python_type(field.kind) + "\n").c_str());
    add_property(cls, std::string(field.name), get, describe(field));
  }
  add_static(
      cls, "fields", [&table] { return field_infos(table); },
      "fields() -> list[ebac._core.Field]\n\n"
      "Return name, unit, meaning, default and range of every parameter.\n");
}

void add_as_dict(const py::object& cls, const FieldTable& table, Place place, const char* what) {
  add_method(
      cls, "as_dict",
      [place, &table](py::handle object) { return values_of(table, place(object)); },
      "as_dict(self: " + full_name(cls) + ") -> dict[str, object]\n\n" + what + "\n");
}

}  // namespace ebac::python
