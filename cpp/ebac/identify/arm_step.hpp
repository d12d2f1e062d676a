#pragma once

#include <Eigen/Core>

#include "ebac/identify/arm_record.hpp"

namespace ebac {

/// One tick of the hand under a force and a target that run straight over it, exact:
///
///   M0 v' = -B0 v - K0 x - F + K0 X0
///
/// Entries of w: x, v, then push = (K0 X0 - F)/M0 at the start and its change over the tick.
struct ArmStep {
  Eigen::Matrix2d phi;     // of x, v
  Eigen::Vector2d start;   // of the push [m/s^2] at the start
  Eigen::Vector2d change;  // of its change
  double per_mass = 0;     // 1/kg
  double stiffness = 0;    // N/m

  ArmStep(const ArmGuess& guess, double dt);

  double push(double force, double target) const EBAC_RT {
    return (stiffness * target - force) * per_mass;
  }
};

}  // namespace ebac
