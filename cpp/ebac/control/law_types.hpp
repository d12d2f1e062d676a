#pragma once

#include <span>
#include <string_view>

#include "ebac/control/any_law.hpp"

namespace ebac {

/// Every law the library ships, in the order of `Laws`.
std::span<const LawType* const> law_types();

/// The law of that name. Throws std::invalid_argument where there is none.
const LawType& law_named(std::string_view name);

}  // namespace ebac
