#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ebac/gastroscope/lumen.hpp"

namespace ebac::gastroscope {

/// The insertion tube from the teeth to the bending section: an elastic rod at rest between the
/// walls, in pieces of 20 mm. The last node lies ahead of the base of the
/// section and only carries its direction.
class InsertionTube {
 public:
  static constexpr std::size_t kMost = 64;
  static constexpr double kStep = 0.02;  // m

  explicit InsertionTube(const Lumen& lumen);

  /// The base of the bending section; how it moves and turns as the tube is advanced.
  struct Base {
    Vec at;
    Frame frame;
    Vec along;  // m/m
    Vec turns;  // 1/m, of its direction
  };
  /// A wall that the section presses: at `arm` [m] from its base, along `way`.
  struct Pressed {
    Vec arm, way;
    double force = 0;      // N
    double stiffness = 0;  // N/m
  };
  /// With the section's base `s` [m] behind the teeth; adds or drops nodes. Between two steps of
  /// `relax` the tube moves evenly: `passed` is the share of the time that has gone.
  Base reach(double s, double passed = 1) EBAC_RT;

  /// A step of `dt` [s] towards rest, with what presses the section ahead of the base, whose
  /// stiffness is in the step, so that it stays stable.
  void relax(double rigidity, double radius, std::span<const Pressed> section,
             const LumenMotion& motion, double dt) EBAC_RT;

  std::size_t nodes() const EBAC_RT { return count_; }
  const Vec& node(std::size_t i) const EBAC_RT { return node_[i]; }
  /// Largest force of the wall on a node [N], the sum of all of them, and that on the stomach as a
  /// bag.
  double most_force() const EBAC_RT { return most_; }
  double all_forces() const EBAC_RT { return all_; }
  const Vec& on_bag() const EBAC_RT { return on_bag_; }
  /// How much of that goes per way of the bag, at most [N/m].
  double holds_bag() const EBAC_RT { return holds_bag_; }

 private:
  void bend(double stiffness) EBAC_RT;
  void press(double radius, const LumenMotion& motion) EBAC_RT;
  void carry(std::span<const Pressed> section) EBAC_RT;
  void solve(double stiffness, double damping) EBAC_RT;

  const Lumen* lumen_;
  std::size_t count_ = 2;
  double share_ = 0;  // of the base between the last two nodes
  std::array<Vec, kMost> node_{}, before_{}, force_{};
  std::array<double, kMost> wall_{};  // N/m, of a wall that is touched
  std::array<Frame, kMost> frame_{};
  std::array<Along, kMost> hint_{};
  double most_ = 0, all_ = 0;
  Vec on_bag_{};
  double holds_bag_ = 0;
};

}  // namespace ebac::gastroscope
