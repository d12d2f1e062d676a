#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/model/kinematics.hpp"

/// The virtual world: a position and a velocity of the handle in, the force it asks for out. A
/// shape is a type with `force(x, v)`; adding one to the variant is all it needs.
namespace ebac {

struct Free {
  Axes force(const Axes&, const Axes&) const EBAC_RT { return Axes::Zero(); }

  static constexpr auto fields() { return std::array<Field<Free>, 0>{}; }
};

/// A flat wall, eq. (12): F = K x + B v inside, along the normal. It never pulls: with v < 0 the
/// damper of eq. (12) as printed could, so the force stops at zero.
struct Wall {
  double stiffness = 10e3;  // N/m
  double damping = 0;       // N s/m
  double position = 0;      // m
  double angle = 0;         // rad

  Axes normal() const EBAC_RT { return {std::cos(angle), std::sin(angle), 0}; }

  Axes force(const Axes& x, const Axes& v) const EBAC_RT {
    if (angle == 0) return {push(x[0], v[0]), 0, 0};
    const Axes n = normal();
    return push(n.dot(x), n.dot(v)) * n;
  }

  double push(double depth, double speed) const EBAC_RT {
    depth -= position;
    if (std::isnan(depth)) return depth;
    return depth >= 0 ? std::max(0.0, stiffness * depth + damping * speed) : 0.0;
  }

  static constexpr auto fields() {
    using F = Field<Wall>;
    return std::array{
        F{"stiffness", &Wall::stiffness, "N/m", "K of eq. (12)", 0, 1e7},
        F{"damping", &Wall::damping, "N s/m", "B of eq. (12)", 0, 1e4},
        F{"position", &Wall::position, "m", "where its surface cuts the normal through the origin",
          -10, 10},
        F{"angle", &Wall::angle, "rad", "direction into the wall, from +x towards +y", -3.2, 3.2},
    };
  }
};

/// Two walls that meet: each pushes along its own normal.
struct Corner {
  Wall first{};
  Wall second{.angle = 1.5707963267948966};

  Axes force(const Axes& x, const Axes& v) const EBAC_RT {
    return first.force(x, v) + second.force(x, v);
  }
};

using Environment = std::variant<Free, Wall, Corner>;

inline Axes force(const Environment& environment, const Axes& x, const Axes& v) EBAC_RT {
  return std::visit([&](const auto& shape) { return shape.force(x, v); }, environment);
}

}  // namespace ebac
