#pragma once

#include <array>
#include <cstddef>

#include "ebac/core/realtime.hpp"
#include "ebac/model/hand_model.hpp"

namespace ebac {

/// Where the handle was: points of its path at most a 64th of the delay apart, cubic between them.
class PathHistory {
 public:
  explicit PathHistory(double delay) : delay_(delay) {}

  void add(const HandMotion& at) EBAC_RT {
    if (count_ > 0 && at.t < point(count_ - 1).t + delay_ / kParts) return;
    if (count_ == points_.size()) {
      first_ = (first_ + 1) % points_.size();
    } else {
      ++count_;
    }
    points_[(first_ + count_ - 1) % points_.size()] = at;
  }

  /// Place and speed `delay` before `t`; at rest at zero before the first point.
  HandMotion before(double t) const EBAC_RT {
    t -= delay_;
    if (count_ < 2 || t <= point(0).t) return {.t = t};
    std::size_t low = 0, high = count_ - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (point(middle).t <= t ? low : high) = middle;
    }
    const HandMotion& a = point(low);
    const HandMotion& b = point(high);
    const double h = b.t - a.t;
    const double s = (t - a.t) / h;
    const double r = 1 - s;
    const double x =
        r * r * ((1 + 2 * s) * a.x + s * h * a.v) + s * s * ((1 + 2 * r) * b.x - r * h * b.v);
    const double v = 6 * s * r * (b.x - a.x) / h + r * (1 - 3 * s) * a.v + s * (3 * s - 2) * b.v;
    return {.t = t, .x = x, .v = v};
  }

 private:
  static constexpr double kParts = 64;

  const HandMotion& point(std::size_t i) const EBAC_RT {
    return points_[(first_ + i) % points_.size()];
  }

  double delay_;
  std::array<HandMotion, 128> points_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace ebac
