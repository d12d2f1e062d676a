#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ebac/model/velocity_of_power.hpp"
#include "ebac/model/world.hpp"
#include "ebac/world/body.hpp"
#include "ebac/world/transported_frame.hpp"

namespace ebac::world {

/// Bodies in space: each has its own proxy, and their forces add up.
class Scene final : public World {
 public:
  explicit Scene(std::vector<Body> bodies) : bodies_(std::move(bodies)) {}

  EBAC_ONE_FUNCTION ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT override {
    // No body is told of such a place, whose proxy would never leave it; the loop ends by what it reads here.
    if (!std::isfinite(x.sum()))
      return ContactForce::straight(Axes::Constant(std::numeric_limits<double>::quiet_NaN()));
    ContactForce all;
    Axes force = Axes::Zero();
    Pushers pushers;
    double pushes = 0;  // N, of all bodies, whatever their directions
    double power = 0;   // W, of their surfaces
    for (Body& body : bodies_) {
      const Touch touch = body.touch(x, v, t);
      if (touch.normals == 0) continue;
      force += touch.force;
      all.depth = std::max(all.depth, touch.depth);
      all.stiffness = std::max(all.stiffness, touch.stiffness);
      pushes += touch.force.norm();
      power += touch.force.dot(touch.velocity);
      if (pushes > 0) all.velocity += touch.force.norm() / pushes * (touch.velocity - all.velocity);
      for (int i = 0; i < touch.normals; ++i) {
        const auto e = static_cast<std::size_t>(i);
        pushers.add({touch.normal[e], touch.push[e]});
      }
    }
    shared_ = pushers.count > 1 || (shared_ && pushers.count > 0);
    if (pushers.count == 0) return all;
    const auto& [first, second] = pushers.strongest;
    all.frame = pushers.count == 1
                    ? frame_.along(&first.normal, 1)
                    : frame_.shared({first.normal, first.push, second.normal, second.push});
    all.shared = shared_;
    if (pushers.count > 1) all.velocity = velocity_of_power(all.velocity, power, force, pushes);
    all.set_force(force);
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
    made->shared_ = false;
    return made;
  }

 private:
  struct Pusher {
    Axes normal = Axes::Zero();
    double push = -1;  // N
  };
  /// The two that push the most.
  struct Pushers {
    std::array<Pusher, 2> strongest;
    int count = 0;

    void add(const Pusher& one) EBAC_RT {
      ++count;
      if (one.push > strongest[0].push) {
        strongest = {one, strongest[0]};
      } else if (one.push > strongest[1].push) {
        strongest[1] = one;
      }
    }
  };

  std::vector<Body> bodies_;
  TransportedFrame frame_;
  bool shared_ = false;  // since this contact has met more than one surface
};

}  // namespace ebac::world
