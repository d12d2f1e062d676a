#include "ebac/core/fields.hpp"

#include <algorithm>

namespace ebac {

double FieldRow::number(const void* owner) const {
  switch (kind) {
    case FieldKind::kDouble:
      return in<double>(owner);
    case FieldKind::kInt64:
      return static_cast<double>(in<std::int64_t>(owner));
    case FieldKind::kInt:
      return in<int>(owner);
    case FieldKind::kFault:
      return static_cast<double>(in<Fault>(owner));
    case FieldKind::kBool:
      return in<bool>(owner) ? 1 : 0;
  }
  return 0;
}

const FieldRow* FieldTable::find(std::string_view name) const {
  const auto found = std::ranges::find(rows, name, &FieldRow::name);
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace ebac
