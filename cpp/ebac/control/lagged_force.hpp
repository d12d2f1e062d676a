#pragma once

#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Force behind a drive's current loop, f' = (u - f) / lag: the force that acts differs from the
/// command, and a part of it acts after the command has ended.
class LaggedForce {
 public:
  explicit LaggedForce(double lag) EBAC_RT : lag_(lag) {}

  void set_tick(double dt) EBAC_RT {
    ticks_ = lag_ / dt;
    decay_ = lag_ > 0 ? std::exp(-dt / lag_) : 0.0;
    share_ = ticks_ * (1 - decay_);
    later_ = decay_ / (1 - decay_);
  }

  /// Holds `command` for one interval; returns the mean force over it.
  double hold(double command) EBAC_RT {
    const double transient = force_ - command;
    force_ = command + transient * decay_;
    return command + transient * share_;
  }

  double force() const EBAC_RT { return force_; }  // N, now

  /// The lag, in ticks: a force whose command has gone acts as long as this in all.
  double ticks() const EBAC_RT { return ticks_; }

  /// How many ticks later than the next one, on average, it does so.
  double later() const EBAC_RT { return later_; }

 private:
  double lag_;        // s
  double force_ = 0;  // N
  double ticks_ = 0;
  double decay_ = 0;  // of a transient, over one interval
  double share_ = 0;  // of a transient, in the mean over one interval
  double later_ = 0;
};

}  // namespace ebac
