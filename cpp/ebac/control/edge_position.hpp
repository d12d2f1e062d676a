#pragma once

#include <algorithm>
#include <limits>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Where the device is within an encoder count, as well as the readings tell.
///
/// A reading tells a band one count wide; the instant it changes tells a place, the edge between two
/// counts. A device that hardly moves is taken to be at the edge it crossed last. One that crosses
/// edge after edge is, on average, in the middle of the band: at the reading.
///
/// A force that toggles with the count does its work at the edge. Counted over whole readings, a
/// held wall loses half a count times every change of the force, and dissolves within a minute.
class EdgePosition {
 public:
  explicit EdgePosition(double count) EBAC_RT : half_(count / 2) {}

  void start(double x) EBAC_RT {
    edge_ = position_ = x;
    between_ = since_ = std::numeric_limits<double>::infinity();
    direction_ = 0;
  }

  /// Takes a reading; returns the displacement since the last one.
  double step(double x, double dt) EBAC_RT {
    const double crossed = std::clamp(edge_, x - half_, x + half_) - edge_;
    edge_ += crossed;
    direction_ = (crossed > 0) - (crossed < 0);
    since_ += dt;
    if (direction_ != 0) {
      between_ = since_;
      since_ = 0;
    }
    const double before = position_;
    position_ = std::max(between_, since_) <= kBrisk ? x : edge_;
    return position_ - before;
  }

  /// Of this tick, single counts to and fro ignored: -1, 0, +1.
  int direction() const EBAC_RT { return direction_; }

 private:
  static constexpr double kBrisk = 0.02;  // s between two edges: 1.5 mm/s at 0.03 mm a count

  double half_;          // m
  double edge_ = 0;      // m, crossed last
  double position_ = 0;  // m
  double between_ = 0;   // s, between the last two crossings
  double since_ = 0;     // s, since the last one
  int direction_ = 0;
};

}  // namespace ebac
