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
/// so that the estimate leads by up to half a count in the mean. It is learned only while the force grows with the
/// way, as on a stiff wall: where a hand strokes a surface, or moves freely with its weight carried, the force is there
/// and says nothing of the way, and the lead alone would act.
class MotorStrength {
 public:
  /// `count` [m], of the encoder.
  explicit MotorStrength(double count) EBAC_RT : lead_(kLead / kSwing * count) {}

  /// The force [N] that `command` makes, in the units of the sensor.
  double of(double command) const EBAC_RT { return value_ * command; }

  /// Takes the command [N] that is given in a tick.
  void give(double command) EBAC_RT {
    change_ = command - command_;
    command_ = command;
  }

  /// Whether there is a command that something can be learned from.
  bool pushes() const EBAC_RT { return std::abs(command_) >= kTouch; }

  /// Takes how far a reading is `off` the estimate [m], a count at most, at the velocity `v` [m/s], `dt` [s] after the
  /// last one.
  void learn(double off, double v, double dt) EBAC_RT {
    const double share = dt / (kMemory + dt);
    grown_ += (change_ - grown_) * share;
    way_ += (v * dt - way_) * share;
    if (!pushes() || grown_ * way_ < kStiff * way_ * way_) return;
    const double swing = std::clamp(v, -kSwing, kSwing);
    value_ -= kRate * (off + lead_ * swing) * swing * dt;
    value_ = std::clamp(value_, 1 - kMost, 1 + kMost);
  }

 private:
  static constexpr double kTouch = 0.5;    // N, a smaller command says nothing
  static constexpr double kStiff = 3e3;    // N/m, nor does a force that grows by less with the way
  static constexpr double kMemory = 0.02;  // s, over which way and growth are averaged
  static constexpr double kSwing = 3e-3;   // m/s, faster counts as this
  static constexpr double kLead = 0.5;  // counts that the estimate shall lead by at that velocity
  static constexpr double kRate = 1e4;  // 1/m^2, slow enough to change little within a swing
  static constexpr double kMost = 0.1;  // learned at most

  double lead_;  // s, that the estimate shall lead by
  double value_ = 1;
  double command_ = 0;  // N
  double change_ = 0;   // N, of the command in the last tick
  double grown_ = 0;    // N, in a tick, averaged
  double way_ = 0;      // m, in a tick, averaged
};

}  // namespace ebac
