#pragma once

#include <cmath>

#include "ebac/model/kinematics.hpp"

namespace ebac::world {

/// Directions that turn with the contact: the first is its normal, the others turn as little as they can.
class TransportedFrame {
 public:
  /// Rows: `count` directions made orthogonal, one after the other, then what is left.
  const Jacobian& along(const Axes* directions, int count) EBAC_RT {
    if (count == 1 && turn_to(directions[0])) return frame_;
    int row = 0;
    for (int i = 0; i < count && row < kMaxAxes; ++i) row = add(directions[i], row);
    for (int i = row; i < kMaxAxes;) {
      const Axes before = frame_.row(i);
      const int added = add(before, i);
      if (added == i) frame_.row(i) = missing(i).transpose();
      ++i;
    }
    return frame_;
  }

 private:
  static constexpr double kParallel =
      0.4;  // sine of the angle below which a direction is none of its own

  /// The usual case, a single unit normal: the second direction turns with it and the third follows from both. False where
  /// the second has become parallel to it.
  bool turn_to(const Axes& normal) EBAC_RT {
    const Axes before = frame_.row(1);
    const Axes rest = before - normal.dot(before) * normal;
    const double square = rest.squaredNorm();
    if (square < kParallel * kParallel) return false;
    const Axes second = (1 / std::sqrt(square)) * rest;
    const Axes third = normal.cross(second);
    const double side = third.dot(frame_.row(2)) < 0 ? -1.0 : 1.0;
    frame_.row(0) = normal;
    frame_.row(1) = second;
    frame_.row(2) = side * third;
    return true;
  }

  /// Puts what of a direction is orthogonal to the rows before into the next one; the number of rows then.
  int add(const Axes& direction, int row) EBAC_RT {
    Axes rest = direction;
    for (int i = 0; i < row; ++i) rest -= frame_.row(i).dot(rest) * frame_.row(i).transpose();
    const double length = rest.norm();
    if (length < kParallel) return row;
    frame_.row(row) = rest / length;
    return row + 1;
  }

  /// Some unit vector orthogonal to the rows before.
  Axes missing(int row) const EBAC_RT {
    Axes best = Axes::Zero();
    for (int i = 0; i < kMaxAxes; ++i) {
      Axes rest = Axes::Unit(i);
      for (int k = 0; k < row; ++k) rest -= frame_.row(k).dot(rest) * frame_.row(k).transpose();
      if (rest.squaredNorm() > best.squaredNorm()) best = rest;
    }
    return best.normalized();
  }

  Jacobian frame_ = Jacobian::Identity();
};

}  // namespace ebac::world
