#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Stiffness of a world as its force shows it, without what its damping adds: dF = K dx + B dv, with
/// dx against the world's surface. B is what two successive changes agree on, where they differ in
/// direction; K follows from the last. A steeper K counts at once, a softer one is followed over 50
/// ticks. B is believed over 50 ticks, and a smaller one at once. Until a contact has shown its slope,
/// changes are those since its first force, however slow the motion and short a tick is.
class StaticSlope {
 public:
  /// Changes below `least` [m] show nothing.
  explicit StaticSlope(double least) EBAC_RT : least_(least) {}

  double value() const EBAC_RT { return slope_; }     // N/m, 0 where unknown
  double damping() const EBAC_RT { return surely_; }  // N s/m, what the world's damping surely is
  /// What this contact has shown of its stiffness before `value` is known [N/m]: at first that of a spring
  /// which begins where the force was 0 a tick before, infinite where the contact did not begin so; 0
  /// where the force does not grow with the way.
  double at_least() const EBAC_RT { return at_least_; }

  /// The last force has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    if (force_ != 0) force_ += change;
  }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    for (double* of : {&force_, &slope_, &damping_, &surely_, &df_, &at_least_}) *of *= by;
  }
  void forget() EBAC_RT { *this = StaticSlope(least_); }

  /// Force [N] at position [m] and velocity [m/s]; `surface` is the way of the world's surface since
  /// the last call [m]. Says whether the slope has changed.
  bool step(double force, double x, double v, double surface) EBAC_RT {
    const double df = force - force_, dx = x - x_ - surface, dv = v - v_;
    const bool both = force != 0 && force_ != 0;
    if (both && slope_ == 0 && std::abs(dx) <= least_) {
      x_ += surface;
      return false;
    }
    if (!both) at_least_ = force != 0 && followed_ ? std::abs(force / dx) : kUnknown;
    followed_ = true;
    force_ = force;
    x_ = x;
    v_ = v;
    if (force == 0) slope_ = damping_ = surely_ = df_ = dx_ = dv_ = 0;
    if (!both || std::abs(dx) <= least_) return false;
    const double turn = dx_ * dv - dx * dv_;
    if (std::abs(turn) > kTurned * (std::abs(dx_ * dv) + std::abs(dx * dv_))) {
      const double bend = dx_ * df - dx * df_;
      const bool damped = std::abs(bend) > kSame * std::abs(dx * df_);
      damping_ = damped ? std::max(0.0, bend / turn) : 0.0;
      surely_ = std::min(surely_ + kForget * (damping_ - surely_), damping_);
    }
    df_ = df;
    dx_ = dx;
    dv_ = dv;
    const double spring = df - damping_ * dv;
    const double seen = std::abs(spring) > kSame * std::abs(df) ? std::max(0.0, spring / dx) : 0.0;
    at_least_ = seen;
    if (std::abs(seen - slope_) <= kSame * slope_) return false;
    slope_ = seen > slope_ ? seen : slope_ + kForget * (seen - slope_);
    return true;
  }

 private:
  static constexpr double kTurned = 0.05;  // of two parts that would cancel in one direction
  static constexpr double kForget = 0.02;  // per tick
  static constexpr double kSame = 1e-9;    // of a value: less is rounding
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double least_;                    // m
  double slope_ = 0, damping_ = 0;  // N/m, N s/m
  double surely_ = 0;               // N s/m, of the damping, as long as it lasts
  double at_least_ = kUnknown;      // N/m
  bool followed_ = false;           // whether the state of the last tick is known
  double force_ = 0, x_ = 0, v_ = 0;
  double df_ = 0, dx_ = 0, dv_ = 0;
};

}  // namespace ebac
