#include "ebac/control/laws.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "ebac/control/law_type.hpp"
#include "ebac/control/law_types.hpp"

namespace ebac {

namespace {

template <class... Law>
std::array<const LawType*, sizeof...(Law)> types_of(const std::tuple<Law...>*) {
  return {&law_type<Law>()...};
}

}  // namespace

std::span<const LawType* const> law_types() {
  static const auto kTypes = types_of(static_cast<const Laws*>(nullptr));
  return kTypes;
}

const LawType& law_named(std::string_view name) {
  const auto types = law_types();
  const auto found = std::ranges::find(types, name, [](const LawType* type) { return type->name; });
  if (found == types.end()) throw std::invalid_argument("no law '" + std::string(name) + "'");
  return **found;
}

}  // namespace ebac
