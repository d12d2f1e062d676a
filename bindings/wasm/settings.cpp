#include "settings.hpp"

#include <stdexcept>
#include <string>

#include "ebac/core/check.hpp"

namespace ebac::wasm {

namespace {

void put(const FieldRow& field, void* owner, double value) {
  switch (field.kind) {
    case FieldKind::kDouble:
      field.in<double>(owner) = value;
      break;
    case FieldKind::kInt:
      field.in<int>(owner) = static_cast<int>(value);
      break;
    case FieldKind::kInt64:
      field.in<std::int64_t>(owner) = static_cast<std::int64_t>(value);
      break;
    case FieldKind::kBool:
      field.in<bool>(owner) = value != 0;
      break;
    case FieldKind::kFault:  // of a row, never of a setting
      break;
  }
}

/// "hand.mass" of the part "hand": "mass"; empty where the name is not of this part.
std::string_view within(const Part& part, std::string_view name) {
  const std::size_t length = part.prefix.size();
  const bool inside = name.size() > length && name.starts_with(part.prefix) && name[length] == '.';
  return inside ? name.substr(length + 1) : std::string_view{};
}

}  // namespace

void set(Setup& setup, std::string_view name, double value) {
  for (const Part& part : parts_of(setup)) {
    const FieldRow* field = part.table->find(within(part, name));
    if (field == nullptr) continue;
    if (!(value >= field->low && value <= field->high)) {  // not so for NaN
      throw std::invalid_argument(
          range_message(part.prefix, field->name, value, field->unit, field->low, field->high));
    }
    return put(*field, part.owner, value);
  }
  throw std::invalid_argument("no setting '" + std::string(name) + "'");
}

}  // namespace ebac::wasm
