#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ebac/core/fields.hpp"

namespace ebac {

/// "EBA.damping = -3 N s/m: must lie in [0, 500]"
inline std::string range_message(std::string_view owner, std::string_view name, double value,
                                 std::string_view unit, double low, double high) {
  std::ostringstream text;
  text << owner << '.' << name << " = " << value;
  if (unit != "1") text << ' ' << unit;
  text << ": must lie in [" << low << ", " << high << ']';
  if (unit != "1") text << ' ' << unit;
  return text.str();
}

/// Throws std::invalid_argument naming the first field of `value` outside its range (NaN is outside).
template <Described T>
void check(const T& value, std::string_view owner) {
  for (const auto& field : T::fields()) {
    std::visit(
        [&](auto member) {
          const auto number = static_cast<double>(value.*member);
          if (!(number >= field.low && number <= field.high)) {
            throw std::invalid_argument(
                range_message(owner, field.name, number, field.unit, field.low, field.high));
          }
        },
        field.member);
  }
}

/// Returns `value` when every field lies in its range; for member initialisers.
template <Described T>
T checked(T value, std::string_view owner) {
  check(value, owner);
  return value;
}

}  // namespace ebac
