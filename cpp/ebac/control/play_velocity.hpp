#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Velocity that ignores the dither of one encoder count: a play operator follows the reading only
/// when it leaves a band one count wide, and a low-pass follows that.
class PlayVelocity {
 public:
  PlayVelocity(double count, double time_constant) EBAC_RT : half_(count / 2),
                                                             lag_(time_constant) {}

  void start(double x) EBAC_RT {
    x_ = x;
    v_ = 0;
    direction_ = 0;
  }

  void set_tick(double dt) EBAC_RT {
    per_dt_ = 1 / dt;
    share_ = dt / (lag_ + dt);
  }

  double step(double x) EBAC_RT {
    const double ahead = x - x_;
    const double moved = std::max(ahead - half_, 0.0) + std::min(ahead + half_, 0.0);
    x_ += moved;
    v_ += (moved * per_dt_ - v_) * share_;
    direction_ = (moved > 0) - (moved < 0);
    return v_;
  }

  int direction() const EBAC_RT { return direction_; }  // of this tick: -1, 0, +1

 private:
  double half_;
  double lag_;
  double per_dt_ = 0;  // 1/s
  double share_ = 1;
  double x_ = 0;
  double v_ = 0;
  int direction_ = 0;
};

}  // namespace ebac
