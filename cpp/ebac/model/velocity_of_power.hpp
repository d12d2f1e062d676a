#pragma once

#include <algorithm>

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// The velocity [m/s] nearest to `about` at which `force` [N] has the power of surfaces [W], that of several bodies or of
/// one in space.
///
/// The laws account for force times velocity, so the work of what moves is theirs exactly. Only where less than a fifth of
/// the `pushes` [N], of which the force is what is left, shows in it, the velocity would be without bound, and part of the
/// power is missing.
inline Axes velocity_of_power(const Axes& about, double power, const Axes& force,
                              double pushes) EBAC_RT {
  constexpr double kLeast = 0.2;
  const double missing = power - force.dot(about);
  const double square = std::max(force.squaredNorm(), kLeast * kLeast * pushes * pushes);
  return square > 0 ? Axes(about + missing / square * force) : about;
}

}  // namespace ebac
