#pragma once

#include <array>
#include <cmath>

#include "ebac/model/kinematics.hpp"
#include "ebac/model/shared_push.hpp"

namespace ebac::world {

/// Directions that turn with the contact: the first is its normal, the others turn as little as they can.
class TransportedFrame {
 public:
  /// Rows: `count` directions made orthogonal, one after the other, then what is left.
  const Jacobian& along(const Axes* directions, int count) EBAC_RT {
    if (count == 1 && turn_to(directions[0])) return frame_;
    int row = 0;
    for (int i = 0; i < count && row < kMaxAxes; ++i) row = add(directions[i], row);
    for (int i = row; i < kMaxAxes; ++i) {
      const Axes before = frame_.row(i);
      const int added = add(before, i);
      if (added == i) frame_.row(i) = missing(i).transpose();
    }
    return frame_;
  }

  /// Rows: the directions of two surfaces that push, then what is left.
  const Jacobian& shared(const SharedPush& pushes) EBAC_RT {
    const std::array<Axes, 2> rows{pushes.first(), pushes.second()};
    return along(rows.data(), pushes.plane() ? 2 : 1);
  }

 private:
  static constexpr double kParallel =
      0.4;  // sine of the angle below which a direction is none of its own

  /// The usual case, a single unit normal: the second direction turns with it and the third follows from both. False where
  /// the second has become parallel to it.
  /// Number by number, since vectors that are stored in parts and read as a whole would stall.
  bool turn_to(const Axes& normal) EBAC_RT {
    const double x = normal[0], y = normal[1], z = normal[2];
    double u = frame_(1, 0), v = frame_(1, 1), w = frame_(1, 2);
    const double common = x * u + y * v + z * w;
    u -= common * x;
    v -= common * y;
    w -= common * z;
    const double square = u * u + v * v + w * w;
    if (square < kParallel * kParallel) return false;
    const double scale = 1 / std::sqrt(square);
    u *= scale;
    v *= scale;
    w *= scale;
    const Axes third{y * w - z * v, z * u - x * w, x * v - y * u};
    const double side = third.dot(frame_.row(2)) < 0 ? -1.0 : 1.0;
    frame_ << x, y, z, u, v, w, side * third[0], side * third[1], side * third[2];
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
