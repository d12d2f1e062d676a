#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Whether something holds the device that the model does not know, as more friction than is declared: its reading has
/// stood for 10 ms, and the model would leave that reading on one side for 1.5 ms. A hand that shakes within a count
/// turns sooner. The more friction is declared, the likelier a device is held, and the sooner it counts as held.
class HeldDevice {
 public:
  /// `friction` [N], as declared.
  explicit HeldDevice(double friction) EBAC_RT
      : leaning_(kLeans* std::max(0.0, 1 - friction / kSticks)) {}

  void restart() EBAC_RT { stands_ = leans_ = 0; }
  void set_tick(double dt) EBAC_RT { taking_ = dt / (kTakes + dt); }

  /// Takes whether the reading stood since the last one, `time` [s] ago, and by how far the estimate was `beyond` it
  /// [m], with its sign.
  void take(bool stood, double beyond, double time) EBAC_RT {
    stands_ = stood ? stands_ + time : 0;
    if (beyond * leans_ <= 0) leans_ = 0;
    if (beyond != 0) leans_ += std::copysign(time, beyond);
  }

  /// Whether it is held against a motion of the model `outwards` (above zero).
  bool held(double outwards) const EBAC_RT {
    return !(stands_ < kStands || outwards <= 0 || std::abs(leans_) < leaning_);
  }

  /// Share of the force that moves the model which counts as that of what holds it, per tick.
  double taking() const EBAC_RT { return taking_; }

 private:
  static constexpr double kStands = 0.01;   // s
  static constexpr double kLeans = 1.5e-3;  // s, without friction
  static constexpr double kSticks = 0.5;    // N, friction with which no time is asked
  static constexpr double kTakes = 2e-3;    // s

  double leaning_;     // s, that the model must leave the reading
  double stands_ = 0;  // s, for which the reading has not changed
  double leans_ = 0;   // s, for which the model would leave it, with the sign of the side
  double taking_ = 0;
};

}  // namespace ebac
