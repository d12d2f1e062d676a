#pragma once

#include <string>
#include <string_view>

#include "ebac/core/fields.hpp"

namespace ebac {

/// The shortest decimal text that reads back as the same number.
std::string shortest(double value);

/// "EBA.damping = -3 N s/m: must lie in [0, 500]"
std::string range_message(std::string_view owner, std::string_view name, double value,
                          std::string_view unit, double low, double high);

/// Throws std::invalid_argument naming the first field of `value` outside its range (NaN is
/// outside).
void check_fields(const FieldTable& table, const void* value, std::string_view owner);

template <Described T>
void check(const T& value, std::string_view owner) {
  check_fields(field_table<T>(), &value, owner);
}

/// Returns `value` when every field lies in its range; for member initialisers.
template <Described T>
T checked(T value, std::string_view owner) {
  check(value, owner);
  return value;
}

}  // namespace ebac
