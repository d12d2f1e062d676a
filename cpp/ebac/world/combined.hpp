#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <utility>
#include <vector>

#include "ebac/world/solid.hpp"

/// Solids made of solids. The distance to a difference or an intersection may come out too small outside, never too large.
namespace ebac::world {

using SolidPtr = std::shared_ptr<const Solid>;

/// Solid where `solid` is not: a sphere becomes a cavity.
class Inverted final : public Solid {
 public:
  explicit Inverted(SolidPtr solid) : solid_(std::move(solid)) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    const Distance at = solid_->distance(x);
    return {-at.d, -at.out};
  }

 private:
  SolidPtr solid_;
};

/// All that belongs to any of several solids.
class Union final : public Solid {
 public:
  explicit Union(std::vector<SolidPtr> solids) : solids_(std::move(solids)) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    Distance nearest = solids_[0]->distance(x);
    for (std::size_t i = 1; i < solids_.size(); ++i) {
      const Distance other = solids_[i]->distance(x);
      if (other.d < nearest.d) nearest = other;
    }
    return nearest;
  }

 private:
  std::vector<SolidPtr> solids_;
};

/// What belongs to all of several solids. `Difference` is one of these: a solid and an inverted one.
class Intersection final : public Solid {
 public:
  explicit Intersection(std::vector<SolidPtr> solids) : solids_(std::move(solids)) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    Distance farthest = solids_[0]->distance(x);
    for (std::size_t i = 1; i < solids_.size(); ++i) {
      const Distance other = solids_[i]->distance(x);
      if (other.d > farthest.d) farthest = other;
    }
    return farthest;
  }

 private:
  std::vector<SolidPtr> solids_;
};

/// A solid at another place, turned.
class Placed final : public Solid {
 public:
  Placed(SolidPtr solid, const Axes& at, const Eigen::Quaterniond& turned)
      : solid_(std::move(solid)), at_(at), turn_(turned.normalized().toRotationMatrix()) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    const Distance own = solid_->distance(turn_.transpose() * (x - at_));
    return {own.d, turn_ * own.out};
  }

 private:
  SolidPtr solid_;
  Axes at_;
  Jacobian turn_;
};

}  // namespace ebac::world
