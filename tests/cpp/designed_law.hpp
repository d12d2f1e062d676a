#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "ebac/control/law_types.hpp"
#include "ebac/sim/setup.hpp"

namespace ebac {

/// A law of the library with the gains it designs for a setup. A test of what runs laws takes this one: a loop
/// compiled for every type of law takes the compiler a minute under sanitizers.
inline AnyLaw designed_law(std::string_view name, const Setup& setup = {}) {
  const LawType& type = law_named(name);
  std::vector<std::max_align_t> params(type.params.size / sizeof(std::max_align_t) + 1);
  type.design(params.data(), setup.device.facts(), setup.timing);
  return type.make(params.data(), setup.timing);
}

}  // namespace ebac
