#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/model/contact_force.hpp"
#include "ebac/model/kinematics.hpp"
#include "ebac/model/world.hpp"

/// The virtual world: maps position and velocity of the handle to a force. A shape is a type with
/// `contact(x, v)`; a new one is added to the variant.
namespace ebac {

struct Free {
  ContactForce contact(const Axes&, const Axes&) const EBAC_RT { return {}; }

  static constexpr auto fields() { return std::array<Field<Free>, 0>{}; }
};

/// K x + B v inside and zero outside, eq. (12). It never pulls: with v < 0 the damper of eq. (12)
/// as printed could, so the force stops at zero.
inline double push(double stiffness, double damping, double depth, double speed) EBAC_RT {
  if (std::isnan(depth)) return depth;
  if (!(depth >= 0)) return 0;
  const double spring = stiffness * depth;
  return std::max(0.0, damping == 0 ? spring : spring + damping * speed);
}

/// A flat wall. It may move to and fro along its normal: what it does to the hand by that is work of
/// the world, which it declares as the velocity of its surface.
struct Wall {
  double stiffness = 10e3;      // N/m
  double damping = 0;           // N s/m
  double position = 0;          // m
  double angle = 0;             // rad
  double motion_amplitude = 0;  // m
  double motion_frequency = 2;  // Hz

  Axes normal() const EBAC_RT { return {std::cos(angle), std::sin(angle), 0}; }

  /// How far `x` lies behind the surface [m], negative before it.
  double depth(const Axes& x) const EBAC_RT {
    return (angle == 0 ? x[0] : normal().dot(x)) - position;
  }

  double push_along(double x, double v) const EBAC_RT {
    return push(stiffness, damping, x - position, v);
  }

  ContactForce contact(const Axes& x, const Axes& v) const EBAC_RT {
    if (angle == 0) return ContactForce::straight({push_along(x[0], v[0]), 0, 0});
    return turned(x, v);
  }

  /// The same at time `t` [s], with the wall where its motion has it.
  ContactForce contact(const Axes& x, const Axes& v, double t) const EBAC_RT {
    return motion_amplitude == 0 ? contact(x, v) : moving(x, v, t);
  }

  static constexpr auto fields() {
    using F = Field<Wall>;
    return std::array{
        F{"stiffness", &Wall::stiffness, "N/m",
          "stiffness of the surface, force per depth: K of eq. (12)", 0, 1e7},
        F{"damping", &Wall::damping, "N s/m",
          "damping of the surface, force per speed in contact: B of eq. (12)", 0, 1e4},
        F{"position", &Wall::position, "m", "where its surface cuts the normal through the origin",
          -10, 10},
        F{"angle", &Wall::angle, "rad", "direction into the wall, from +x towards +y", -3.2, 3.2},
        F{"motion_amplitude", &Wall::motion_amplitude, "m",
          "of a sine along the normal; not in a Corner", 0, 0.1},
        F{"motion_frequency", &Wall::motion_frequency, "Hz", "of that motion", 0, 100},
    };
  }

 private:
  ContactForce turned(const Axes& x, const Axes& v) const EBAC_RT;
  ContactForce moving(const Axes& x, const Axes& v, double t) const EBAC_RT;
};

/// Two walls that meet: each pushes along its own normal.
struct Corner {
  Wall first{};
  Wall second{.angle = std::numbers::pi / 2};

  ContactForce contact(const Axes& x, const Axes& v) const EBAC_RT;
};

/// A round pillar in the plane of the first two axes, met from outside.
struct Disc {
  double stiffness = 10e3;  // N/m
  double damping = 0;       // N s/m
  double x = 0.03;          // m
  double y = 0;             // m
  double radius = 0.02;     // m

  ContactForce contact(const Axes& at, const Axes& v) const EBAC_RT;

  static constexpr auto fields() {
    using F = Field<Disc>;
    return std::array{
        F{"stiffness", &Disc::stiffness, "N/m",
          "stiffness of the surface, force per depth: K of eq. (12), along the radius", 0, 1e7},
        F{"damping", &Disc::damping, "N s/m",
          "damping of the surface, force per speed in contact: B of eq. (12), along the radius", 0,
          1e4},
        F{"x", &Disc::x, "m", "centre", -10, 10},
        F{"y", &Disc::y, "m", "centre", -10, 10},
        F{"radius", &Disc::radius, "m", "radius", 1e-4, 10},
    };
  }
};

/// A world of another kind: a scene of bodies, an engine. Each signal chain meets a fresh copy of its own.
struct External {
  std::shared_ptr<World> world;

  ContactForce contact(const Axes& x, const Axes& v, double t) const EBAC_RT {
    return world == nullptr ? ContactForce{} : world->contact(x, v, t);
  }
};

using Environment = std::variant<Free, Wall, Corner, Disc, External>;

/// The same environment, without memory of another run.
Environment fresh(const Environment& environment);

/// What any but a wall gives.
ContactForce contact_with_other(const Environment& environment, const Axes& x, const Axes& v,
                                double t) EBAC_RT;

/// At time `t` [s] of the run.
inline ContactForce contact(const Environment& environment, const Axes& x, const Axes& v,
                            double t) EBAC_RT {
  const auto* wall = std::get_if<Wall>(&environment);
  return wall != nullptr ? wall->contact(x, v, t) : contact_with_other(environment, x, v, t);
}

}  // namespace ebac
