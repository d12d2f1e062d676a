#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ebac/world/solid.hpp"

namespace ebac::world {

/// A solid as its signed distance at the nodes of a grid, fine near the surface and coarse elsewhere: whatever it was made
/// from, a contact costs the same.
///
/// Each node has distance and direction. Between the eight nodes of a cell their tangent planes are blended, so that plane
/// surfaces are exact and the direction is continuous. Far from the surface a bound of the distance is enough.
class DistanceGrid final : public Solid {
 public:
  static constexpr int kCells = 8;  // of a brick, along each edge
  static constexpr int kNodes = kCells + 1;
  static constexpr std::size_t kBrick = std::size_t{4} * kNodes * kNodes * kNodes;
  static constexpr std::int32_t kFar = -1;

  struct Layout {
    Axes origin = Axes::Zero();   // m, of the first node
    double cell = 1e-3;           // m, edge of a cell
    std::array<int, 3> bricks{};  // number along each edge
    double margin = 0;            // m, that surrounds the solid within the grid
  };

  /// `far`: distance at the corners of the bricks [m], (bricks + 1) along each edge. `index`: of each brick, the number of
  /// its nodes in `nodes`, or `kFar`. `nodes`: direction and distance of each node. The last coordinate changes first.
  DistanceGrid(const Layout& layout, std::vector<float> far, std::vector<std::int32_t> index,
               std::vector<float> nodes)
      : layout_(layout),
        per_cell_(1 / layout.cell),
        far_(std::move(far)),
        index_(std::move(index)),
        nodes_(std::move(nodes)) {}

  Distance distance(const Axes& x) const EBAC_RT override {
    const Axes scaled = per_cell_ * (x - layout_.origin);
    Place at;
    for (std::size_t i = 0; i < 3; ++i) {
      const double place = scaled[static_cast<int>(i)];
      const bool within_grid = place >= 0 && place < kCells * layout_.bricks[i];
      if (!within_grid) return outside(x);
      const int cell = static_cast<int>(place);
      at.brick[i] = static_cast<unsigned>(cell) / kCells;
      at.cell[i] = static_cast<unsigned>(cell) % kCells;
      at.u[i] = place - cell;
    }
    const auto& size = layout_.bricks;
    const std::int32_t which = index_[number(at.brick, size[1], size[2])];
    return which == kFar ? far(at) : near(which, at);
  }

 private:
  /// Where in the grid a point is.
  struct Place {
    std::array<std::size_t, 3> brick{};
    std::array<std::size_t, 3> cell{};  // of the brick
    std::array<double, 3> u{};          // in the cell, 0 to 1
  };

  /// Of one of a block of things that has `y` and `z` of them along the second and third edge.
  static std::size_t number(const std::array<std::size_t, 3>& at, int y, int z) EBAC_RT {
    return (at[0] * static_cast<std::size_t>(y) + at[1]) * static_cast<std::size_t>(z) + at[2];
  }

  /// Not in the grid: at least as far as the grid's own edge, and the margin.
  Distance outside(const Axes& x) const EBAC_RT {
    Axes beyond;
    for (int i = 0; i < 3; ++i) {
      const double size = layout_.cell * kCells * layout_.bricks[static_cast<std::size_t>(i)];
      const double own = x[i] - layout_.origin[i];
      beyond[i] = own - std::clamp(own, 0.0, size);
    }
    Distance at = from_centre(beyond, Axes::UnitX());
    at.d += layout_.margin;
    return at;
  }

  /// No surface within a cell of this brick, and no distance changes faster than the place.
  Distance far(const Place& at) const EBAC_RT {
    std::array<std::size_t, 3> corner = at.brick;
    Axes off;  // m, from the nearest corner
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<int>(i);
      const double within = static_cast<double>(at.cell[i]) + at.u[i];
      const bool upper = within > 0.5 * kCells;
      corner[i] += upper ? 1 : 0;
      off[axis] = layout_.cell * (within - (upper ? kCells : 0));
    }
    const double d = far_[number(corner, layout_.bricks[1] + 1, layout_.bricks[2] + 1)];
    const double least = std::max(std::abs(d) - off.norm(), layout_.cell);
    return {std::copysign(least, d), Axes::UnitX()};
  }

  /// Sum over the eight nodes of weight times (distance + direction . way from the node): as
  /// u . sum(w n) less the share of the nodes at 1 along each coordinate, so that all is done four
  /// numbers at a time.
  EBAC_ONE_FUNCTION Distance near(std::int32_t which, const Place& at) const EBAC_RT {
    const auto [x, y, z] = at.u;
    const float* const first = nodes_.data() + static_cast<std::size_t>(which) * kBrick +
                               4 * number(at.cell, kNodes, kNodes);
    const double low = (1 - x) * (1 - y), across = (1 - x) * y, along = x * (1 - y), high = x * y;
    constexpr std::ptrdiff_t kY = std::ptrdiff_t{4} * kNodes, kX = kY * kNodes;
    const Row a(first, low, 1 - z, z), b(first + kY, across, 1 - z, z);
    const Row c(first + kX, along, 1 - z, z), e(first + kX + kY, high, 1 - z, z);
    const Eigen::Array4d upper_x = c.sum + e.sum;
    const Eigen::Array4d all = a.sum + b.sum + upper_x;
    const double moved = x * all[0] - upper_x[0] + y * all[1] - (b.sum[1] + e.sum[1]) + z * all[2] -
                         (a.upper + b.upper + c.upper + e.upper);
    const double length = std::sqrt(all[0] * all[0] + all[1] * all[1] + all[2] * all[2]);
    const double d = all[3] + layout_.cell * moved;
    if (!(length > 0)) return {d, Axes::UnitX()};
    const double scale = 1 / length;
    return {d, {scale * all[0], scale * all[1], scale * all[2]}};
  }

  /// Two nodes next to each other along the last coordinate, by their weights.
  struct Row {
    Row(const float* nodes, double weight, double lower_share, double upper_share) EBAC_RT {
      using Node = Eigen::Map<const Eigen::Array4f>;
      const Eigen::Array4d second = weight * upper_share * Node(nodes + 4).cast<double>();
      sum = weight * lower_share * Node(nodes).cast<double>() + second;
      upper = second[2];
    }
    Eigen::Array4d sum;
    double upper;
  };

  Layout layout_;
  double per_cell_;         // 1/m
  std::vector<float> far_;  // m
  std::vector<std::int32_t> index_;
  std::vector<float> nodes_;
};

}  // namespace ebac::world
