#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/core/fields.hpp"
#include "ebac/world/solid.hpp"

/// Simple shapes about the origin, along the axes of the device. `Placed` puts them elsewhere.
namespace ebac::world {

/// Everything behind the plane x = 0.
struct Plane {
  Distance distance(const Axes& x) const EBAC_RT { return {-x[0], -Axes::UnitX()}; }

  static constexpr auto fields() { return std::array<Field<Plane>, 0>{}; }
};

struct Sphere {
  double radius = 0.02;  // m

  Distance distance(const Axes& x) const EBAC_RT {
    Distance at = from_centre(x, Axes::UnitX());
    at.d -= radius;
    return at;
  }

  static constexpr auto fields() {
    return std::array{Field<Sphere>{"radius", &Sphere::radius, "m", "radius", 1e-4, 10}};
  }
};

struct Box {
  double width = 0.04;   // m, along x
  double depth = 0.04;   // m, along y
  double height = 0.04;  // m, along z

  Distance distance(const Axes& x) const EBAC_RT {
    const Axes q = x.cwiseAbs() - 0.5 * Axes{width, depth, height};
    const Axes sign = x.unaryExpr([](double one) { return std::copysign(1.0, one); });
    Eigen::Index face = 0;
    const double nearest = q.maxCoeff(&face);
    if (nearest <= 0) return {nearest, sign[face] * Axes::Unit(face)};
    const Axes beyond = q.cwiseMax(0);
    const double length = beyond.norm();
    return {length, sign.cwiseProduct(beyond) / length};
  }

  static constexpr auto fields() {
    using F = Field<Box>;
    return std::array{
        F{"width", &Box::width, "m", "size along x", 1e-4, 10},
        F{"depth", &Box::depth, "m", "size along y", 1e-4, 10},
        F{"height", &Box::height, "m", "size along z", 1e-4, 10},
    };
  }
};

/// With its axis along z.
struct Cylinder {
  double radius = 0.02;  // m
  double length = 0.1;   // m

  Distance distance(const Axes& x) const EBAC_RT {
    const Distance axis = from_centre({x[0], x[1], 0}, Axes::UnitX());
    const Axes up = std::copysign(1.0, x[2]) * Axes::UnitZ();
    const double side = axis.d - radius;
    const double end = std::abs(x[2]) - 0.5 * length;
    if (side <= 0 || end <= 0) return side > end ? Distance{side, axis.out} : Distance{end, up};
    const double corner = std::hypot(side, end);
    return {corner, (side * axis.out + end * up) / corner};
  }

  static constexpr auto fields() {
    using F = Field<Cylinder>;
    return std::array{
        F{"radius", &Cylinder::radius, "m", "radius", 1e-4, 10},
        F{"length", &Cylinder::length, "m", "length along z", 1e-4, 100},
    };
  }
};

/// A cylinder along z with half a sphere on each end.
struct Capsule {
  double radius = 0.02;  // m
  double length = 0.1;   // m, between the centres of the spheres

  Distance distance(const Axes& x) const EBAC_RT {
    const double z = std::clamp(x[2], -0.5 * length, 0.5 * length);
    Distance at = from_centre(x - z * Axes::UnitZ(), Axes::UnitX());
    at.d -= radius;
    return at;
  }

  static constexpr auto fields() {
    using F = Field<Capsule>;
    return std::array{
        F{"radius", &Capsule::radius, "m", "radius", 1e-4, 10},
        F{"length", &Capsule::length, "m", "between the centres of its ends", 0, 100},
    };
  }
};

/// A ring about z.
struct Torus {
  double radius = 0.03;  // m, of its centre line
  double tube = 0.01;    // m, radius of the tube

  Distance distance(const Axes& x) const EBAC_RT {
    const Distance axis = from_centre({x[0], x[1], 0}, Axes::UnitX());
    Distance at = from_centre(x - radius * axis.out, axis.out);
    at.d -= tube;
    return at;
  }

  static constexpr auto fields() {
    using F = Field<Torus>;
    return std::array{
        F{"radius", &Torus::radius, "m", "radius of the ring's centre line", 1e-4, 10},
        F{"tube", &Torus::tube, "m", "radius of the tube", 1e-4, 10},
    };
  }
};

}  // namespace ebac::world
