#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// The mean over an interval of the parabola through three readings, the last at its end [N].
constexpr double mean_of_readings(double now, double last, double before) EBAC_RT {
  return (5 * now + 8 * last - before) * (1.0 / 12);
}

/// What that mean misses of a force that echoes the motor's: a hand's mass, which the motor pushes, too, gives a part of
/// each step back. A sensor without a filter shows the step when it is over, and the parabola puts it too late. What it
/// misses of the motor's own force is known.
class MotorEcho {
 public:
  /// Begins where the sensor shows so much of the motor's force [N].
  void restart(double shown) EBAC_RT { shown_ = before_ = shown; }

  /// `lag` of the sensor [s].
  void set_tick(double lag, double dt) EBAC_RT {
    share_ = kShare * std::max(0.0, 1 - lag / (kFiltered * dt));
  }

  /// Whether the sensor is so quick.
  bool heard() const EBAC_RT { return share_ > 0; }

  /// Takes what is shown of the motor's force at the end of an interval, and the true mean of that over it [N]; returns
  /// what is missed of the hand's.
  double missed(double shown, double mean) EBAC_RT {
    const double motor = mean - mean_of_readings(shown, shown_, before_);
    before_ = shown_;
    shown_ = shown;
    return share_ * motor;
  }

 private:
  static constexpr double kShare = 0.9;     // that a hand gives back, to a sensor without lag
  static constexpr double kFiltered = 0.4;  // of a tick: a lag from which nothing is missed

  double share_ = 0;
  double shown_ = 0;   // N, at the last reading
  double before_ = 0;  // N, at the one before
};

}  // namespace ebac
