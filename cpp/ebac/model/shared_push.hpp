#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Directions for two surfaces that push at once, along unit normals that need not be square to each other.
///
/// Where one pushes alone, its normal is a direction, and where both push alike, the directions are halfway from one such
/// place to the other, on the shorter way there: 45 degrees at most, and none where the normals are square.
class SharedPush {
 public:
  /// Surfaces with normals `n` and `m`, which push with `one` and `other` [N].
  SharedPush(const Axes& n, double one, const Axes& m, double other) EBAC_RT : n_(n) {
    const double cosine = n.dot(m);
    across_ = m - cosine * n;
    const double sine = across_.norm();
    if (sine > kParallel) across_ /= sine;
    const double least = std::remainder(std::atan2(sine, cosine), std::numbers::pi / 2);
    turn_ = std::abs(least) < kSquare ? 0.0 : least;
    angle_ = way(one, other) * turn_;
    plane_ = sine > kParallel;
  }

  /// Whether the normals span a plane: otherwise one direction is all there is to say.
  bool plane() const EBAC_RT { return plane_; }
  /// From a place where `n` is a direction to one where `m` is [rad].
  double turn() const EBAC_RT { return turn_; }
  /// The first direction, next to `n`.
  Axes first() const EBAC_RT {
    return plane_ ? Axes(std::cos(angle_) * n_ + std::sin(angle_) * across_) : n_;
  }
  /// The second, in the plane of both normals.
  Axes second() const EBAC_RT { return std::cos(angle_) * across_ - std::sin(angle_) * n_; }

 private:
  /// The part of the turn that is gone.
  static double way(double one, double other) EBAC_RT {
    const double share = other > 0 ? other / (one + other) : 0.0;
    return share < 0.5 ? std::min(0.5, share / kBoth) : 1 - std::min(0.5, (1 - share) / kBoth);
  }

  static constexpr double kBoth = 0.3;  // of the push: with more of it from either, both push alike
  static constexpr double kParallel = 1e-2;  // sine of the angle between normals that span no plane
  static constexpr double kSquare = 1e-9;    // rad

  Axes n_;
  Axes across_;
  double turn_;
  double angle_;
  bool plane_;
};

}  // namespace ebac
