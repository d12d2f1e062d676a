#include "ebac/core/check.hpp"

#include <array>
#include <charconv>
#include <stdexcept>

namespace ebac {

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string range_message(std::string_view owner, std::string_view name, double value,
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

void check_fields(const FieldTable& table, const void* value, std::string_view owner) {
  for (const FieldRow& field : table.rows) {
    const double number = field.number(value);
    const bool inside = number >= field.low && number <= field.high;  // not so for NaN
    if (inside) continue;
    throw std::invalid_argument(
        range_message(owner, field.name, number, field.unit, field.low, field.high));
  }
}

}  // namespace ebac
