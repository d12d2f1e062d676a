#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "ebac/sim/sweep.hpp"
#include "fields.hpp"

/// Many runs in one call: their results as columns.
namespace ebac::python {

/// A NumPy array of `get(row)` for every row.
template <class Value, class Row, class Get>
py::array_t<Value> column(const std::vector<Row>& rows, Get get) {
  py::array_t<Value> values(static_cast<py::ssize_t>(rows.size()));
  py::ssize_t i = 0;
  for (const Row& row : rows) values.mutable_at(i++) = static_cast<Value>(get(row));
  return values;
}

/// Adds a column for each field of a part of the rows.
template <Described Part, class Row, class Get>
void add_columns(Values& columns, const std::vector<Row>& rows, Get part) {
  for (const FieldRow& field : field_table<Part>().rows) {
    columns[py::str(std::string(field.name))] =
        column<double>(rows, [&](const Row& row) { return field.number(&part(row)); });
  }
}

inline Values columns_of(const std::vector<Outcome>& rows) {
  Values columns;
  add_columns<WallContact>(columns, rows,
                           [](const Outcome& o) -> const WallContact& { return o.contact; });
  columns["rest_power"] = column<double>(rows, [](const Outcome& o) { return o.rest_power; });
  columns["still"] =
      column<bool>(rows, [](const Outcome& o) { return o.whole() && o.contact.still(); });
  columns["force_quiet"] =
      column<bool>(rows, [](const Outcome& o) { return o.whole() && o.contact.force_quiet(); });
  columns["quiet"] =
      column<bool>(rows, [](const Outcome& o) { return o.whole() && o.contact.quiet(); });
  columns["ticks"] = column<std::int64_t>(rows, [](const Outcome& o) { return o.ticks; });
  columns["fault"] = column<std::uint32_t>(rows, [](const Outcome& o) { return o.fault; });
  columns["diverged"] = column<bool>(rows, [](const Outcome& o) { return o.diverged; });
  columns["done"] = column<bool>(rows, [](const Outcome& o) { return o.done; });
  return columns;
}

template <class T>
void require_all(const std::vector<const T*>& parts, const char* name) {
  for (const T* part : parts) {
    if (part == nullptr) throw py::type_error(std::string(name) + " holds None");
  }
}

}  // namespace ebac::python
