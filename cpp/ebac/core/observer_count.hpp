#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Change of a hand's force within a tick that an observer bears [N].
inline constexpr double kSudden = 1.1;

/// The count that observer and account reckon with [m]: `count`, or of a finer encoder the way on which `kSudden` takes a
/// mass [kg] in a tick [s], kSudden dt^2 / mass. What the force does between two readings of its sensor is unknown, and
/// would move the device over whole counts: every reading would contradict the model.
inline double observer_count(double count, double mass, double dt) EBAC_RT {
  return std::max(count, kSudden * dt * dt / mass);
}

}  // namespace ebac
