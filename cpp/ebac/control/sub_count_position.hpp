#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Estimates the position of the device within an encoder count.
///
/// A reading gives a band one count wide; the instant of its change gives a position, the edge
/// between two counts. A device that hardly moves is taken to be at the edge it crossed last. One
/// that crosses edge after edge is taken to continue at this pace; after a reversal, to be in the
/// middle of the band, at the reading.
///
/// A force that toggles with the count does its work at the edge. Computed from whole readings, a
/// held wall loses half a count times every change of the force, and dissolves within a minute; and
/// at half a count per tick the pulses of a damper seem to dissipate up to twice their energy.
class SubCountPosition {
 public:
  explicit SubCountPosition(double count) EBAC_RT : count_(count) {}

  void start(double x) EBAC_RT {
    edge_ = position_ = x;
    between_ = since_ = std::numeric_limits<double>::infinity();
    pace_ = 0;
    direction_ = heading_ = 0;
    on_ = false;
  }

  /// Takes a reading; returns the displacement since the last one.
  double step(double x, double dt) EBAC_RT {
    const double edge = std::clamp(edge_, x - count_ / 2, x + count_ / 2);
    const double crossed = edge - edge_;
    const double rounding = count_ / 4;  // an edge met again may differ by the last digit
    direction_ = (crossed > rounding) - (crossed < -rounding);
    edge_ = edge;
    since_ += dt;
    if (direction_ != 0) {
      on_ = direction_ == heading_;
      pace_ = std::abs(crossed) / since_;
      heading_ = direction_;
      between_ = since_;
      since_ = 0;
    }
    const double before = position_;
    position_ = place(x, dt);
    return position_ - before;
  }

  /// Of this tick, single counts to and fro ignored: -1, 0, +1.
  int direction() const EBAC_RT { return direction_; }

 private:
  double place(double x, double dt) const EBAC_RT {
    if (std::max(between_, since_) > kBrisk) return edge_;
    if (!on_) return x;
    const double pace =
        std::min(pace_, count_ / (since_ + dt));         // slower, the longer no new edge comes
    return edge_ + heading_ * pace * (since_ + dt / 2);  // crossed half a tick before it was read
  }

  static constexpr double kBrisk = 0.02;  // s between two edges: 1.5 mm/s at 0.03 mm a count

  double count_;         // m
  double edge_ = 0;      // m, crossed last
  double position_ = 0;  // m
  double between_ = 0;   // s, between the last two crossings
  double since_ = 0;     // s, since the last one
  double pace_ = 0;      // m/s, from one to the other
  int direction_ = 0;
  int heading_ = 0;  // of the last crossing
  bool on_ = false;  // the last two crossings had one direction
};

}  // namespace ebac
