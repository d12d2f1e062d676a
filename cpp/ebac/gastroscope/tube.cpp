#include "ebac/gastroscope/tube.hpp"

#include <algorithm>

namespace ebac::gastroscope {

namespace {

constexpr double kDrag =
    1.5;  // N s/m of a node: mucus; assumed, sets only how fast it comes to rest

}  // namespace

InsertionTube::InsertionTube(const Lumen& lumen) : lumen_(&lumen) {
  frame_[0] = frame_[1] = lumen.frame(0);
  node_[0] = lumen.middle(0, {});
  node_[1] = node_[0] + kStep * frame_[0].z;
  before_ = node_;
}

InsertionTube::Base InsertionTube::reach(double s, double passed) EBAC_RT {
  // Not by a clamp: of what is no number it makes no place.
  const double place = s > 0 ? std::min(s / kStep, static_cast<double>(kMost) - 3) : 0.0;
  const auto before = static_cast<std::size_t>(place);
  share_ = place - static_cast<double>(before);
  while (count_ < before + 2) {
    const Vec ahead = unit(node_[count_ - 1] - node_[count_ - 2], frame_[count_ - 1].z);
    node_[count_] = node_[count_ - 1] + kStep * ahead;
    frame_[count_] = look_along(frame_[count_ - 1], ahead);
    before_[count_] = node_[count_];
    hint_[count_] = hint_[count_ - 1];
    ++count_;
  }
  count_ = before + 2;
  const auto now = [&](std::size_t i)
                       EBAC_RT { return before_[i] + passed * (node_[i] - before_[i]); };
  const Vec last = now(before);
  const Vec lead = now(before + 1);
  const Vec way = lead - last;
  const Vec behind = before > 0 ? last - now(before - 1) : frame_[0].z;
  const Vec from = unit(behind, frame_[0].z), to = unit(way, behind);
  const Vec ahead = unit((1 - share_) * from + share_ * to, frame_[before].z);
  return {last + share_ * way, look_along(frame_[before], ahead), (1 / kStep) * way,
          (1 / kStep) * (to - from)};
}

/// The gradient of the bending energy, E I / (2 h^3) sum |p[i-1] - 2 p[i] + p[i+1]|^2.
void InsertionTube::bend(double stiffness) EBAC_RT {
  for (std::size_t j = 0; j + 1 < count_; ++j) {
    const Vec before = j > 0 ? node_[j - 1] : node_[0] - kStep * frame_[0].z;
    const Vec turn = stiffness * (before - 2.0 * node_[j] + node_[j + 1]);
    if (j > 0) force_[j - 1] -= turn;
    force_[j] += 2.0 * turn;
    force_[j + 1] -= turn;
  }
}

/// The walls along the tube; the last node is ahead of it, and the first in the bite block.
void InsertionTube::press(double radius, const LumenMotion& motion) EBAC_RT {
  const double stiffness = lumen_->params().stiffness;
  most_ = all_ = holds_bag_ = 0;
  on_bag_ = {};
  for (std::size_t i = 1; i + 1 < count_; ++i) {
    wall_[i] = 0;
    const WallNear wall = lumen_->near(node_[i], radius, motion, hint_[i]);
    if (!(wall.depth > 0)) continue;
    wall_[i] = stiffness * dot(wall.way, wall.way);
    const Vec push = stiffness * wall.depth * wall.way;
    force_[i] -= push;
    on_bag_ += wall.moves * push;
    holds_bag_ += wall.moves * wall.moves * wall_[i];
    const double size = norm(push);
    all_ += size;
    most_ = std::max(most_, size);
  }
}

/// What presses the section goes to the last two nodes, which its base moves and turns with. Its
/// stiffness goes to each of both by itself, which is no less than together: where all of it was put
/// between them, the section bounced from wall to wall.
void InsertionTube::carry(std::span<const Pressed> section) EBAC_RT {
  const std::size_t lead = count_ - 1;
  const Vec& ahead = frame_[lead].z;
  for (const Pressed& wall : section) {
    if (!(wall.force > 0)) continue;
    const Vec turns =
        (1 / kStep) * (dot(wall.arm, ahead) * wall.way - dot(wall.way, ahead) * wall.arm);
    const Vec first = (1 - share_) * wall.way - turns, second = share_ * wall.way + turns;
    force_[lead - 1] -= wall.force * first;
    force_[lead] -= wall.force * second;
    const double one = norm(first), two = norm(second);
    wall_[lead - 1] += wall.stiffness * one * (one + two);
    wall_[lead] += wall.stiffness * two * (one + two);
  }
}

/// Node 0 is held. (D + stiffness B) step = force, five bands, by Cholesky's method; then the
/// tube gets its length again: node i is 20 mm i of tube behind the teeth.
void InsertionTube::solve(double stiffness, double damping) EBAC_RT {
  std::array<double, kMost> d{}, l1{}, l2{};
  const std::size_t n = count_;
  for (std::size_t i = 1; i < n; ++i) {
    // Each row of B counts the bends it is part of: as left end, middle and right end.
    const double ends = (i + 2 < n ? 1.0 : 0.0) + 1.0;
    double own = damping + wall_[i] + stiffness * (ends + (i + 1 < n ? 4.0 : 0.0));
    double near = 0, far = 0;
    if (i > 1) near = stiffness * (-2.0 - (i + 1 < n ? 2.0 : 0.0));
    if (i > 2) far = stiffness;
    if (i > 2) {
      l2[i] = far / d[i - 2];
      near -= l2[i] * d[i - 2] * l1[i - 1];
      own -= l2[i] * l2[i] * d[i - 2];
    }
    if (i > 1) {
      l1[i] = near / d[i - 1];
      own -= l1[i] * l1[i] * d[i - 1];
    }
    d[i] = own;
    if (i > 1) force_[i] -= l1[i] * force_[i - 1];
    if (i > 2) force_[i] -= l2[i] * force_[i - 2];
  }
  for (std::size_t i = n; i-- > 1;) {
    Vec step = (1 / d[i]) * force_[i];
    if (i + 1 < n) step -= l1[i + 1] * force_[i + 1];
    if (i + 2 < n) step -= l2[i + 2] * force_[i + 2];
    force_[i] = step;
  }
  for (std::size_t i = 1; i < n; ++i) {
    before_[i] = node_[i];
    const Vec ahead = unit(node_[i] + force_[i] - node_[i - 1], frame_[i].z);
    node_[i] = node_[i - 1] + kStep * ahead;
    frame_[i] = look_along(frame_[i - 1], ahead);
  }
}

void InsertionTube::relax(double rigidity, double radius, std::span<const Pressed> section,
                          const LumenMotion& motion, double dt) EBAC_RT {
  const double stiffness = rigidity / (kStep * kStep * kStep);
  for (std::size_t i = 0; i < count_; ++i) {
    force_[i] = {};
    wall_[i] = 0;
  }
  bend(stiffness);
  press(radius, motion);
  carry(section);
  for (std::size_t i = 1; i < count_; ++i) {
    const Vec& along = frame_[i].z;  // what goes along the tube, it bears
    force_[i] -= dot(force_[i], along) * along;
  }
  solve(stiffness, kDrag / dt);
}

}  // namespace ebac::gastroscope
