#pragma once

#include <cmath>
#include <string>

#include "ebac/core/check.hpp"

namespace ebac {

/// The number rounded to six digits, for a message: 0.125 of a product that is 0.12500000000000003.
/// Streams do the same and bring their locales along, a quarter of the WebAssembly module.
inline std::string six_digits(double value) {
  if (value == 0 || !std::isfinite(value)) return shortest(value);
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  const double rounded = std::round(value * scale) / scale;
  return shortest(std::isfinite(rounded) ? rounded : value);
}

}  // namespace ebac
