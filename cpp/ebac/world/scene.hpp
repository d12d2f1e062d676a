#pragma once

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ebac/model/world.hpp"
#include "ebac/world/body.hpp"
#include "ebac/world/transported_frame.hpp"

namespace ebac::world {

/// Bodies in space: each has its own proxy, and their forces add up.
class Scene final : public World {
 public:
  explicit Scene(std::vector<Body> bodies) : bodies_(std::move(bodies)) {}

  EBAC_ONE_FUNCTION ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT override {
    ContactForce all;
    // No body is told of such a place, whose proxy would never leave it; the loop ends by what it reads here.
    if (!std::isfinite(x.sum()))
      return ContactForce::straight(Axes::Constant(std::numeric_limits<double>::quiet_NaN()));
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
    all.turned = all.frame(0, 0) != 1 || !all.frame.isIdentity(0);
    return all;
  }

  /// The nearest surface of all, for a handle outside.
  Near near(const Axes& x, double t) const EBAC_RT {
    Near nearest;
    for (const Body& body : bodies_) {
      if (const Near one = body.near(x, t); one.distance < nearest.distance) nearest = one;
    }
    return nearest;
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
