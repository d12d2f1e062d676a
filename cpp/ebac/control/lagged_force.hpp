#pragma once

#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// What is left of a transient of a first-order lag over an interval with a constant input.
struct Transient {
  double end = 0;   // at its end
  double mean = 0;  // in its mean

  Transient() = default;
  Transient(double lag, double dt) EBAC_RT : end(lag > 0 ? std::exp(-dt / lag) : 0.0),
                                             mean(lag / dt * (1 - end)) {}
};

/// Force behind a drive's current loop, f' = (u - f) / lag: the force that acts differs from the
/// command, and a part of it acts after the command has ended.
class LaggedForce {
 public:
  explicit LaggedForce(double lag) EBAC_RT : lag_(lag) {}

  void set_tick(double dt) EBAC_RT {
    ticks_ = lag_ / dt;
    left_ = Transient(lag_, dt);
    later_ = left_.end / (1 - left_.end);
    moment_ = lag_ * (left_.mean - left_.end) - 0.5 * dt * left_.mean;
    spread_ = 0.5 * lag_ * (1 - left_.end * left_.end) - dt * left_.mean * left_.mean;
  }

  /// Holds `command` for one interval; returns the mean force over it.
  double hold(double command) EBAC_RT {
    const double transient = force_ - command;
    force_ = command + transient * left_.end;
    return command + transient * left_.mean;
  }

  /// Moment of the force about the middle of an interval that holds `command`, the integral of f (t/T - 1/2) [N s]:
  /// over a velocity that changes by c the force does c times this more than its mean does.
  double moment(double command) const EBAC_RT { return (force_ - command) * moment_; }

  /// Integral of (f - mean)^2 over an interval that holds `command` [N^2 s]: with a damping b, a velocity that
  /// follows it makes the force give out at most a fourth of it over b more than its mean does.
  double spread(double command) const EBAC_RT {
    return (force_ - command) * (force_ - command) * spread_;
  }

  double force() const EBAC_RT { return force_; }  // N, now
  const Transient& left() const EBAC_RT { return left_; }

  /// The lag, in ticks: a force whose command has gone acts as long as this in all.
  double ticks() const EBAC_RT { return ticks_; }

  /// How many ticks later than the next one, on average, it does so.
  double later() const EBAC_RT { return later_; }

 private:
  double lag_;        // s
  double force_ = 0;  // N
  Transient left_;
  double ticks_ = 0;
  double later_ = 0;
  double moment_ = 0;  // s
  double spread_ = 0;  // s
};

}  // namespace ebac
