#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "axes_argument.hpp"
#include "ebac/core/check.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::python {

/// Counts of each drive at the zero of its axis; none given are all 0. `owner` and `name` are those of the message.
inline std::array<std::int32_t, kMaxAxes> zero_of(const std::string& owner, const std::string& name,
                                                  const std::vector<std::int64_t>& given,
                                                  int axes) {
  using Counts = std::numeric_limits<std::int32_t>;
  std::array<std::int32_t, kMaxAxes> zero{};
  if (given.empty()) return zero;
  check_axes(owner + "." + name, given.size(), axes);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] < Counts::min() || given[i] > Counts::max()) {
      throw std::invalid_argument(range_message(owner, name, static_cast<double>(given[i]),
                                                "counts", Counts::min(), Counts::max()));
    }
    zero[i] = static_cast<std::int32_t>(given[i]);
  }
  return zero;
}

}  // namespace ebac::python
