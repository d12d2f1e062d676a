#include "ebac/model/limits.hpp"

#include <stdexcept>

#include "ebac/core/check.hpp"

namespace ebac {

void check_limits(const Limits& limits) {
  check(limits, "Limits");
  if (limits.peak_current < limits.continuous_current) {
    throw std::invalid_argument(range_message("Limits", "continuous_current",
                                              limits.continuous_current, "A", 1e-3,
                                              limits.peak_current) +
                                ", up to peak_current");
  }
  if (limits.end < limits.edge) {
    throw std::invalid_argument(
        range_message("Limits", "edge", limits.edge, "m", 1e-3, limits.end) + ", up to end");
  }
}

}  // namespace ebac
