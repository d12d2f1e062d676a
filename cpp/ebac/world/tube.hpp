#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ebac/world/solid.hpp"

namespace ebac::world {

/// All that is within a radius of a curve, given as points with straight lines between them; the radius changes evenly from
/// point to point. Its cavity is a lumen.
class Tube final : public Solid {
 public:
  struct Point {
    Axes at;        // m
    double radius;  // m
  };

  /// Two points at least, no two neighbours at the same place, the radius by less than the way between them.
  explicit Tube(std::vector<Point> points) : points_(std::move(points)) {}

  Distance distance(const Axes& x) const EBAC_RT override {
    Distance nearest{.d = HUGE_VAL};
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Distance at = from_cone(points_[i], points_[i + 1], x);
      if (at.d < nearest.d) nearest = at;
    }
    return nearest;
  }

 private:
  /// A cone between two balls, touching both: the centre of the ball that is nearest lies a little towards the wider end
  /// from the foot of the plumb line.
  static Distance from_cone(const Point& a, const Point& b, const Axes& x) EBAC_RT {
    const Axes way = b.at - a.at;
    const double length = way.norm();
    const Axes along = way / length;
    const double slope = (a.radius - b.radius) / length;
    const double foot = along.dot(x - a.at);
    const double aside = (x - a.at - foot * along).norm();
    const double best =
        std::clamp(foot - aside * slope / std::sqrt(1 - slope * slope), 0.0, length);
    Distance at = from_centre(x - a.at - best * along, along.unitOrthogonal());
    at.d -= a.radius - slope * best;
    return at;
  }

  std::vector<Point> points_;
};

}  // namespace ebac::world
