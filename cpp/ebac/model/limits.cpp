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
                                ", up to peak_current; change both");
  }
  if (limits.end < limits.edge) {
    throw std::invalid_argument(
        range_message("Limits", "edge", limits.edge, "m", 1e-3, limits.end) + ", up to end");
  }
}

void check_ways(const Limits& limits, const DeviceModel& device) {
  const double shorter = shorter_ways(device.kinematics).head(device.axes()).maxCoeff();
  if (limits.edge > shorter) return;
  throw std::invalid_argument(
      range_message("Limits", "edge", limits.edge, "m", shorter, limits.end) +
      ": it lies as far before the stops of every axis, which leaves the slide no way; raise edge "
      "or "
      "SlidingGimbal.slide_limit");
}

}  // namespace ebac
