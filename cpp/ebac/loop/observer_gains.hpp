#pragma once

#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// What an innovation changes of the three states of `AxisObserver`: of x [1], u [1/s], and D times
/// the mass [1/s^2].
struct ObserverGains {
  double x = 0, v = 0, d = 0;

  /// Poles at two times `bandwidth` for x and u, one at `slow` of it for D.
  static ObserverGains of(double bandwidth, double slow, double dt) EBAC_RT {
    const double z = std::exp(-bandwidth * dt);
    const double q = std::exp(-slow * bandwidth * dt);
    return {1 - z * z * q, ((1 - z) * (1 - z) + (1 - q) * (1 - z) * (1 + z)) / dt,
            (1 - z) * (1 - z) * (1 - q) / (dt * dt)};
  }
  ObserverGains towards(const ObserverGains& other, double share) const EBAC_RT {
    return {x + share * (other.x - x), v + share * (other.v - v), d + share * (other.d - d)};
  }
};

}  // namespace ebac
