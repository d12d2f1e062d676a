#pragma once

#include <utility>
#include <vector>

#include "ebac/model/world.hpp"
#include "ebac/world/body.hpp"

namespace ebac::world {

/// Directions that turn with the contact: the first is its normal, the others turn as little as they can.
class TransportedFrame {
 public:
  /// Rows: `count` directions made orthogonal, one after the other, then what is left.
  const Jacobian& along(const Axes* directions, int count) EBAC_RT {
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

/// Bodies in space: each has its own proxy, and their forces add up.
class Scene final : public World {
 public:
  explicit Scene(std::vector<Body> bodies) : bodies_(std::move(bodies)) {}

  ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT override {
    ContactForce all;
    std::array<Axes, kMaxAxes> normals;
    int count = 0;
    double strongest = 0;
    for (Body& body : bodies_) {
      const Touch touch = body.touch(x, v, t);
      if (touch.normals == 0) continue;
      all.force += touch.force;
      all.depth = std::max(all.depth, touch.depth);
      all.stiffness = std::max(all.stiffness, touch.stiffness);
      if (const double force = touch.force.norm(); count == 0 || force > strongest) {
        strongest = force;
        all.velocity = touch.velocity;
      }
      for (int i = 0; i < touch.normals && count < kMaxAxes; ++i)
        normals[static_cast<std::size_t>(count++)] = touch.normal[static_cast<std::size_t>(i)];
    }
    if (count == 0) return all;
    all.frame = frame_.along(normals.data(), count);
    all.along = all.frame * all.force;
    all.turned = !all.frame.isIdentity(0);
    return all;
  }

  double stored() const EBAC_RT override {
    double sum = 0;
    for (const Body& body : bodies_) sum += body.stored();
    return sum;
  }

  std::unique_ptr<World> fresh() const override {
    auto made = std::make_unique<Scene>(*this);
    for (Body& body : made->bodies_) body.reset();
    made->frame_ = {};
    return made;
  }

 private:
  std::vector<Body> bodies_;
  TransportedFrame frame_;
};

}  // namespace ebac::world
