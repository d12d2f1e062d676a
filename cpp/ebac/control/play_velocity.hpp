#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Velocity that ignores the dither of one encoder count: a play operator follows the reading only when it
/// leaves a band one count wide, and a low-pass follows that.
class PlayVelocity {
 public:
  PlayVelocity(double count, double time_constant) EBAC_RT : half_(count / 2), lag_(time_constant) {}

  void start(double x) EBAC_RT {
    x_ = x;
    v_ = 0;
    direction_ = 0;
  }

  double step(double x, double dt) EBAC_RT {
    const double moved = std::clamp(x_, x - half_, x + half_) - x_;
    x_ += moved;
    v_ += (moved / dt - v_) * dt / (lag_ + dt);
    direction_ = moved > 0 ? 1 : moved < 0 ? -1 : 0;
    return v_;
  }

  int direction() const EBAC_RT { return direction_; }  // of this tick: -1, 0, +1

 private:
  double half_;
  double lag_;
  double x_ = 0;
  double v_ = 0;
  int direction_ = 0;
};

}  // namespace ebac
