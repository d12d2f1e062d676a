#pragma once

#include <cmath>
#include <memory>

#include "ebac/world/engine/local_model.hpp"
#include "ebac/world/scene.hpp"

namespace ebac::world {

/// Somebody else's simulation, called in simulated time: where the handle is, in; a model of the world near it, out.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual LocalModel answer(const Axes& x, const Axes& v, double t) EBAC_RT = 0;
  /// The same engine without memory, for another run.
  virtual std::unique_ptr<Engine> fresh() const = 0;

 protected:
  Engine() = default;
  Engine(const Engine&) = default;
  Engine& operator=(const Engine&) = default;
};

/// Bodies of our own as an engine: the plane across the force, or that of the nearest surface.
class SceneEngine final : public Engine {
 public:
  explicit SceneEngine(const Scene& scene) : scene_(scene) {}

  LocalModel answer(const Axes& x, const Axes&, double t) EBAC_RT override {
    const ContactForce contact = scene_.contact(x, Axes::Zero(), t);
    const double force = contact.force.norm();
    if (!std::isfinite(force)) return {.stiffness = force, .t = t};
    if (force > 0 && contact.stiffness > 0) {
      const Axes into = contact.force / force;
      return {.at = x - force / contact.stiffness * into,
              .into = into,
              .stiffness = contact.stiffness,
              .velocity = contact.velocity,
              .t = t,
              .surface = true};
    }
    const Near near = scene_.near(x, t);
    return {.at = x - near.distance * near.out,
            .into = -near.out,
            .stiffness = near.stiffness,
            .velocity = near.velocity,
            .t = t,
            .surface = near.distance >= 0};
  }

  std::unique_ptr<Engine> fresh() const override {
    const std::unique_ptr<World> untouched = scene_.fresh();
    return std::make_unique<SceneEngine>(static_cast<const Scene&>(*untouched));
  }

 private:
  Scene scene_;
};

}  // namespace ebac::world
