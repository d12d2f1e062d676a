#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/model/mechanics.hpp"

namespace ebac {

/// Dry friction of one joint, referred to the handle: Coulomb friction, with Stribeck's rise
/// towards standstill.
struct Friction {
  double coulomb;    // N
  double breakaway;  // N, largest static friction
  double fall;       // m/s, speed over which one becomes the other

  explicit Friction(const Mechanics& m)
      : coulomb(m.coulomb), breakaway(std::max(m.breakaway, m.coulomb)), fall(m.stribeck_speed) {}

  bool present() const EBAC_RT { return breakaway > 0; }

  double sliding(double speed) const EBAC_RT {
    if (breakaway == coulomb) return coulomb;
    const double share = speed / fall;
    return coulomb + (breakaway - coulomb) * std::exp(-share * share);
  }

  /// How steeply it falls with speed [N s/m]; a negative damping, so it never makes a step
  /// unstable.
  double slope() const EBAC_RT { return (breakaway - coulomb) / fall; }
};

}  // namespace ebac
