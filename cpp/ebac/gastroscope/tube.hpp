#pragma once

#include <array>
#include <cstddef>

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

  /// The base of the bending section.
  struct Base {
    Vec at;
    Frame frame;
  };
  /// With the section's base `s` [m] behind the teeth; adds or drops nodes. Between two steps of
  /// `relax` the tube moves evenly: `passed` is the share of the time that has gone.
  Base reach(double s, double passed = 1) EBAC_RT;

  /// A step of `dt` [s] towards rest, with a force [N] and a moment [N m] on the base. They come from
  /// a wall `reach` [m] ahead of it, whose stiffness is in the step, so that it stays stable.
  void relax(double rigidity, double radius, double reach, const Vec& force, const Vec& moment,
             const LumenMotion& motion, double dt) EBAC_RT;

  std::size_t nodes() const EBAC_RT { return count_; }
  const Vec& node(std::size_t i) const EBAC_RT { return node_[i]; }
  /// Largest force of the wall on a node [N], the sum of all of them, and that on the stomach as a
  /// bag.
  double most_force() const EBAC_RT { return most_; }
  double all_forces() const EBAC_RT { return all_; }
  const Vec& on_bag() const EBAC_RT { return on_bag_; }

 private:
  void bend(double stiffness) EBAC_RT;
  void press(double radius, const LumenMotion& motion) EBAC_RT;
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
};

}  // namespace ebac::gastroscope
