#pragma once

#include <span>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac {

/// One member of every axis, zero for the axes not in use.
template <class Part>
Axes of_all(std::span<const Axis> axes, Part Axis::* part, double Part::* member) EBAC_RT {
  const auto of = [&](std::size_t i) { return i < axes.size() ? axes[i].*part.*member : 0.0; };
  return {of(0), of(1), of(2)};
}

}  // namespace ebac
