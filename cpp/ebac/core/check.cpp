#include "ebac/core/check.hpp"

#include <array>
#include <charconv>
#include <stdexcept>

namespace ebac {
namespace {

/// "; 40 mm is 0.04 m" where a value well beyond its range would lie in it, meant in thousandths.
std::string in_thousandths(double value, std::string_view unit, double low, double high) {
  const double meant = value / 1000;
  if (!(value > 1.1 * high && meant >= low && meant <= high)) return {};
  const std::string_view small = unit == "m" ? "mm" : unit == "kg" ? "g" : unit == "s" ? "ms" : "";
  if (small.empty()) return {};
  std::string text("; ");
  text.append(shortest(value)).append(" ").append(small).append(" is ");
  return text.append(shortest(meant)).append(" ").append(unit);
}

}  // namespace

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
  text.append(gap).append(of);
  return text.append(in_thousandths(value, unit, low, high));
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
