#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/model/kinematics.hpp"

namespace ebac::world {

/// What an engine says of the world near the handle: a plane or sphere, how stiff it is, how it moves. The tick renders it
/// until the next one comes.
struct LocalModel {
  Axes at = Axes::Zero();        // m, on the surface
  Axes into = Axes::UnitX();     // unit vector into the body there
  double curvature = 0;          // 1/m: 0 a plane, above 0 a ball, below 0 a hollow
  double stiffness = 0;          // N/m
  double damping = 0;            // N s/m
  Axes velocity = Axes::Zero();  // m/s, of the surface
  double t = 0;                  // s of the run: when the handle was where this was computed for
  bool surface = false;          // false: nothing near

  // Ranges of what comes from another program: also those of `ebac.worlds.LocalModel`.
  static constexpr double kFarthest = 10;        // m, along each axis
  static constexpr double kFastest = 10;         // m/s, along each axis
  static constexpr double kOffUnit = 1e-6;       // of the length of `into`
  static constexpr double kMostCurvature = 1e4;  // 1/m
  static constexpr double kStiffest = 1e7;       // N/m
  static constexpr double kMostDamping = 1e4;    // N s/m

  /// Whether all numbers are within these ranges.
  bool in_range() const EBAC_RT {
    return at.cwiseAbs().maxCoeff() <= kFarthest && velocity.cwiseAbs().maxCoeff() <= kFastest &&
           std::abs(into.norm() - 1) <= kOffUnit && std::abs(curvature) <= kMostCurvature &&
           stiffness >= 0 && stiffness <= kStiffest && damping >= 0 && damping <= kMostDamping &&
           finite();
  }
  /// Whether all numbers are.
  bool finite() const EBAC_RT {
    return std::isfinite(at.sum() + into.sum() + velocity.sum() + curvature + stiffness + damping +
                         t);
  }

  /// Depth of a point [m], negative outside, and its gradient, the unit vector into the body.
  struct Depth {
    double d;
    Axes into;
  };

  /// `since` [s] after `t`. For a sphere of radius R = 1/curvature it is R - |x - centre|, written so that R may be infinite.
  Depth depth(const Axes& x, double since) const EBAC_RT {
    const Axes p = x - at - since * velocity;
    const double along = into.dot(p);
    if (curvature == 0) return {along, into};
    const double square = p.squaredNorm();
    const double q =
        std::sqrt(std::max(0.0, 1 - 2 * curvature * along + curvature * curvature * square));
    const Axes towards = into - curvature * p;
    return {(2 * along - curvature * square) / (1 + q), q > 0 ? Axes(towards / q) : into};
  }
};

}  // namespace ebac::world
