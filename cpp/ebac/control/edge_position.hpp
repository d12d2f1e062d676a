#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Where the device is within an encoder count.
///
/// A reading tells a band one count wide; the instant it changes tells a place, the edge between two
/// counts. From the edge crossed last the device is taken to go on at the pace of the last two
/// crossings in one direction, slower the longer no new one comes, and to stay at the edge after a
/// reversal. A force that toggles with the count does work over these displacements, not over whole
/// counts: an account on whole counts loses up to half a count times every change of the force.
class EdgePosition {
 public:
  explicit EdgePosition(double count) EBAC_RT : count_(count) {}

  void start(double x) EBAC_RT {
    edge_ = position_ = x;
    pace_ = 0;
    ticks_ = 1;
    direction_ = heading_ = 0;
  }

  /// Takes a reading; returns the displacement since the last one.
  double step(double x) EBAC_RT {
    const double crossed = std::clamp(edge_, x - count_ / 2, x + count_ / 2) - edge_;
    edge_ += crossed;
    direction_ = (crossed > 0) - (crossed < 0);
    if (direction_ == 0) {
      ticks_ += 1;
    } else {
      pace_ = direction_ == heading_ ? std::abs(crossed) / ticks_ : 0.0;
      heading_ = direction_;
      ticks_ = 1;
    }
    const double before = position_;
    position_ = edge_ + heading_ * std::min(pace_, count_ / ticks_) * (ticks_ - 0.5);
    return position_ - before;
  }

  /// Of this tick, single counts to and fro ignored: -1, 0, +1.
  int direction() const EBAC_RT { return direction_; }

 private:
  double count_;         // m
  double edge_ = 0;      // m, crossed last
  double position_ = 0;  // m
  double pace_ = 0;      // m per tick
  double ticks_ = 1;     // since the last crossing, which was half a tick before its reading
  int direction_ = 0;
  int heading_ = 0;
};

}  // namespace ebac
