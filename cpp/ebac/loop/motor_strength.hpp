#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Strength of the motor over what the force sensor shows of it, learned from swings on a world.
///
/// Where the sensor shows less than the motor gives, the estimate of a device that swings on a world lags behind the
/// readings by `off`, and the swing draws off v of energy. Strength follows
///
///   s' = -rate (off + lead) v
///
/// so that the estimate leads by up to half a count in the mean. Without a force, nothing is learned.
class MotorStrength {
 public:
  /// `count` [m], of the encoder.
  explicit MotorStrength(double count) EBAC_RT : lead_(kLead / kSwing * count) {}

  /// The force [N] that `command` makes, in the units of the sensor.
  double of(double command) const EBAC_RT { return value_ * command; }

  /// Takes how far a reading is `off` the estimate [m], a count at most, at the velocity `v` [m/s] and the `force` of
  /// the motor [N]; `dt` [s] since the last one.
  void learn(double off, double v, double force, double dt) EBAC_RT {
    if (std::abs(force) < kTouch) return;
    const double swing = std::clamp(v, -kSwing, kSwing);
    value_ -= kRate * (off + lead_ * swing) * swing * dt;
    value_ = std::clamp(value_, 1 - kMost, 1 + kMost);
  }

 private:
  static constexpr double kTouch = 0.5;  // N, of the motor, from here on the device touches a world
  static constexpr double kSwing = 3e-3;  // m/s, faster counts as this
  static constexpr double kLead = 0.5;    // counts that the estimate shall lead by at that velocity
  static constexpr double kRate = 1e4;    // 1/m^2, slow enough to change little within a swing
  static constexpr double kMost = 0.1;    // learned at most

  double lead_;  // s, that the estimate shall lead by
  double value_ = 1;
};

}  // namespace ebac
