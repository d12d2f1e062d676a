#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ebac/core/fields.hpp"

namespace ebac {

/// A number in the fewest digits that tell it from its neighbours.
inline std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// "EBA.damping = -3 N s/m: must lie in [0, 500]"
inline std::string range_message(std::string_view owner, std::string_view name, double value,
                                 std::string_view unit, double low, double high) {
  std::string text(owner);
  const std::string_view gap = unit == "1" ? "" : " ";
  const std::string_view of = unit == "1" ? "" : unit;
  text.append(".").append(name).append(" = ").append(shortest(value)).append(gap).append(of);
  text.append(": must lie in [")
      .append(shortest(low))
      .append(", ")
      .append(shortest(high))
      .append("]");
  return text.append(gap).append(of);
}

/// Throws std::invalid_argument naming the first field of `value` outside its range (NaN is
/// outside).
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
