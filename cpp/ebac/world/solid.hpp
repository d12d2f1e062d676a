#pragma once

#include <concepts>

#include "ebac/model/kinematics.hpp"

/// Solids that a handle meets, by their signed distance. A shape is a type with `distance(x)`.
namespace ebac::world {

/// How far a point is from a surface [m], negative inside, and the unit vector that points away from the solid.
///
/// Never more than the true distance outside, so that a step of that length meets nothing; exact near the surface.
/// Waves (`Textured`) are exact there to first order only.
struct Distance {
  double d = 0;
  Axes out = Axes::UnitX();
};

template <class S>
concept Shape = requires(const S& shape, const Axes& x) {
  { shape.distance(x) } noexcept -> std::same_as<Distance>;
};

/// A solid of any shape.
class Solid {
 public:
  virtual ~Solid() = default;
  virtual Distance distance(const Axes& x) const EBAC_RT = 0;

 protected:
  Solid() = default;
  Solid(const Solid&) = default;
  Solid& operator=(const Solid&) = default;
};

/// One shape as a solid.
template <Shape S>
class SolidOf final : public Solid {
 public:
  explicit SolidOf(const S& shape) : shape_(shape) {}
  Distance distance(const Axes& x) const EBAC_RT override { return shape_.distance(x); }
  const S& shape() const { return shape_; }

 private:
  S shape_;
};

/// A vector's length and direction; `other` where it has none.
inline Distance from_centre(const Axes& r, const Axes& other) EBAC_RT {
  const double length = r.norm();
  return {length, length > 0 ? Axes(r / length) : other};
}

}  // namespace ebac::world
