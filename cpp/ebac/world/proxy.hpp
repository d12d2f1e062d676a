#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "ebac/world/solid.hpp"

namespace ebac::world {

/// The point of a solid's surface that stands for the handle inside it: the god-object of Zilles and
/// Salisbury (1995), on a signed distance in place of triangles.
///
/// Outside it is the handle. Inside it stays on the surface that the handle came through, as near to
/// the handle as planes tangent to that surface let it: what is thinner than the handle is deep does
/// not give way, and in a concave corner up to three planes hold it. A plane is replaced by a better
/// one of nearly the same direction until the surface is met within `kExact`. Where it is smooth, the proxy is at the
/// point nearest to the handle within `kFlat` along the surface, which is the usual case and takes one distance.
class Proxy {
 public:
  static constexpr double kExact = 1e-9;     // m
  static constexpr double kStride = 0.5e-3;  // m, at a time: parts must be thicker than twice that
  static constexpr int kMostStrides = 16;
  static constexpr double kSameSurface = 0.9;  // cosine between the normals of one smooth surface

  /// A plane that the proxy may not pass.
  struct Constraint {
    Axes at;           // m, a point of it
    Axes out;          // unit normal away from the solid
    double depth = 0;  // m, its part of the way from the handle to the proxy
  };

  bool touching() const EBAC_RT { return count_ > 0; }
  const Axes& place() const EBAC_RT { return place_; }
  int constraints() const EBAC_RT { return count_; }
  const Constraint& constraint(int i) const EBAC_RT { return held_[index(i)]; }

  /// From here on free, at `x`.
  void put(const Axes& x) EBAC_RT {
    place_ = x;
    room_ = 0;
    count_ = 0;
    begun_ = true;
  }

  /// Follows the handle to `x`.
  void follow(const Solid& solid, const Axes& x) EBAC_RT {
    if (!begun_) put(x);
    if (!touching() && travel(solid, x)) {
      learnt_ = false;
      return;
    }
    if (!glide(solid, x)) slide(solid, x);
    learn(x);
  }

 private:
  /// Free motion towards `x`; whether it gets there.
  bool travel(const Solid& solid, const Axes& x) EBAC_RT {
    const Distance there = solid.distance(x);
    const Axes way = x - place_;
    const double length = way.norm();
    if (there.d > 0 && length <= room_ + there.d) {  // two balls without surface cover the way
      place_ = x;
      room_ = there.d;
      return true;
    }
    Distance here = solid.distance(place_);
    double gone = 0;
    for (int i = 0; i < kMostSteps && gone < length && here.d > kExact; ++i) {
      gone = std::min(gone + here.d, length);
      here = solid.distance(place_ + gone / length * way);
    }
    room_ = std::max(here.d, 0.0);
    if (gone >= length && here.d > 0) {
      place_ = x;
      return true;
    }
    if (length > 0) place_ += gone / length * way;
    hold(here.out);
    return false;
  }

  /// The usual case, a smooth surface and a handle that has moved little: the plane tangent to the surface where it is
  /// expected to hold the handle, and again where that was not near enough. False where this is no such case.
  bool glide(const Solid& solid, const Axes& x) EBAC_RT {
    if (count_ != 1 || !learnt_) return false;
    Axes expected = x + offset_ + turning_ * (x - before_);
    for (int i = 0; i < kMostTries; ++i) {
      if ((expected - place_).squaredNorm() > kStride * kStride) return false;
      const Distance at = solid.distance(expected);
      if (std::abs(at.d) > kSurface || held_[0].out.dot(at.out) < kSameSurface) return false;
      const double behind = at.out.dot(expected - x) - at.d;
      if (behind <= kExact) return false;
      const Axes goal = x + behind * at.out;
      if ((goal - expected).squaredNorm() <= kFlat * kFlat) {
        held_[0] = {goal, at.out, behind};
        place_ = goal;
        return true;
      }
      expected = goal;
    }
    return false;
  }

  /// How the way from handle to proxy changes with the handle, after Broyden (1965); at first that of a plane.
  void learn(const Axes& x) EBAC_RT {
    if (count_ != 1) {
      learnt_ = false;
      return;
    }
    const Axes offset = place_ - x;
    const Axes moved = x - before_;
    const double square = moved.squaredNorm();
    if (!learnt_) {
      turning_ = -held_[0].out * held_[0].out.transpose();
    } else if (square > kLearns * kLearns) {
      const Axes missed = offset - offset_ - turning_ * moved;
      for (int i = 0; i < kMaxAxes; ++i) turning_.col(i) += (moved[i] / square) * missed;
    }
    learnt_ = true;
    offset_ = offset;
    before_ = x;
  }

  /// Along the surface towards `x`, or away from it.
  void slide(const Solid& solid, const Axes& x) EBAC_RT {
    for (int i = 0; i < kMostStrides; ++i) {
      const Axes goal = nearest(x);
      const Axes way = goal - place_;
      const bool arrives = way.squaredNorm() <= kStride * kStride;
      const Axes next = arrives ? goal : Axes(place_ + kStride / way.norm() * way);
      const Distance at = solid.distance(next);
      if (at.d < -kExact) {  // another surface, or the same one further on
        place_ = next - at.d * at.out;
        hold(at.out, i < kSettles ? kSameSurface : kSamePlane);
        continue;
      }
      place_ = next;
      if (arrives && (next - x).squaredNorm() == 0) {
        count_ = 0;
        room_ = std::max(at.d, 0.0);
        return;
      }
      if (at.d > kExact) {  // the surface has fallen away below
        update(at);
        if (touching()) continue;
        room_ = 0;
        if (travel(solid, x)) return;  // it has ended: free again, until something is met
        continue;
      }
      if (arrives) return;
    }
    // The rest of the way in the next tick, without planes that the handle has left behind.
    nearest(x);
  }

  /// The surface has fallen away below a point: another tangent plane of it, or none where it has ended.
  void update(const Distance& at) EBAC_RT {
    const int same = most_parallel(at.out);
    if (same >= 0 && held_[index(same)].out.dot(at.out) > kSameSurface) {
      held_[index(same)] = {place_ - at.d * at.out, at.out};
    } else {
      count_ = 0;
    }
  }

  /// A plane at `place_`: in place of one of the same surface, beside those of others. `same` is the cosine between two
  /// normals from which on they are one surface's: where a smooth surface would have been met by now, there are two.
  void hold(const Axes& out, double same = kSameSurface) EBAC_RT {
    int which = most_parallel(out);
    const bool other = which < 0 || held_[index(which)].out.dot(out) <= same;
    if (other && count_ < kMaxAxes) which = count_++;
    held_[index(which)] = {place_, out};
  }

  int most_parallel(const Axes& out) const EBAC_RT {
    int best = -1;
    for (int i = 0; i < count_; ++i) {
      if (best < 0 || held_[index(i)].out.dot(out) > held_[index(best)].out.dot(out)) best = i;
    }
    return best;
  }

  /// The point nearest to `x` that lies behind no plane; planes that do not keep it are let go.
  Axes nearest(const Axes& x) EBAC_RT {
    if (count_ == 1) return nearest_on_one(x);
    for (int planes = 0; planes <= count_; ++planes) {
      for (unsigned set = 0; set < 1U << static_cast<unsigned>(count_); ++set) {
        if (std::popcount(set) != planes) continue;
        Axes goal = x;
        if (!solve(set, x, goal)) continue;
        keep(set);
        return goal;
      }
    }
    return place_;
  }

  /// The same for a single plane, the usual case.
  Axes nearest_on_one(const Axes& x) EBAC_RT {
    const Constraint& plane = held_[0];
    const double behind = plane.out.dot(plane.at - x);
    if (behind <= kExact) {
      count_ = 0;
      return x;
    }
    held_[0].depth = behind;
    return x + behind * plane.out;
  }

  /// The point nearest to `x` on all planes of a set, if these push it there and no other plane is passed.
  bool solve(unsigned set, const Axes& x, Axes& goal) EBAC_RT {
    Jacobian gram = Jacobian::Identity();
    Axes missing = Axes::Zero();
    for (int i = 0; i < count_; ++i) {
      if (!has(set, i)) continue;
      missing[i] = held_[index(i)].out.dot(held_[index(i)].at - x);
      for (int j = 0; j < count_; ++j) {
        if (has(set, j)) gram(i, j) = held_[index(i)].out.dot(held_[index(j)].out);
      }
    }
    if (std::popcount(set) == 1) {
      // the matrix is the identity
    } else if (std::abs(gram.determinant()) < kParallel) {
      return false;
    } else {
      missing = gram.inverse() * missing;
    }
    for (int i = 0; i < count_; ++i) {
      if (!has(set, i)) continue;
      if (missing[i] <= 0) return false;  // it would pull
      goal += missing[i] * held_[index(i)].out;
    }
    for (int i = 0; i < count_; ++i) {
      if (!has(set, i) && held_[index(i)].out.dot(goal - held_[index(i)].at) < -kExact)
        return false;
    }
    for (int i = 0; i < count_; ++i) held_[index(i)].depth = missing[i];
    return true;
  }

  void keep(unsigned set) EBAC_RT {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      if (has(set, i)) held_[index(kept++)] = held_[index(i)];
    }
    count_ = kept;
  }

  static bool has(unsigned set, int i) EBAC_RT {
    return (set >> static_cast<unsigned>(i) & 1U) != 0;
  }
  static std::size_t index(int i) EBAC_RT { return static_cast<std::size_t>(i); }

  static constexpr int kMostSteps = 64;
  static constexpr double kParallel = 1e-5;
  static constexpr int kMostTries = 4;
  static constexpr int kSettles =
      6;  // strides in which one tangent plane of a smooth surface is found
  static constexpr double kSamePlane = 0.99995;  // cosine, 0.6 degrees
  static constexpr double kSurface = 1e-6;       // m, off the surface
  static constexpr double kFlat = 1e-7;          // m, over which a surface is its tangent plane
  static constexpr double kLearns = 1e-6;        // m

  Axes place_ = Axes::Zero();
  double room_ = 0;  // m, radius of a ball about `place_` without any surface
  bool learnt_ = false;
  Axes before_ = Axes::Zero();           // m, the handle at the tick before
  Axes offset_ = Axes::Zero();           // m, from there to `place_`
  Jacobian turning_ = Jacobian::Zero();  // of `offset_` by the handle
  std::array<Constraint, kMaxAxes> held_{};
  int count_ = 0;
  bool begun_ = false;
};

}  // namespace ebac::world
