#pragma once

#include <cmath>

#include "ebac/control/lagged_force.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// The motor's force: as it acts, behind the current loop, and as a force sensor would show it, behind
/// the sensor's lag as well.
class MotorForce {
 public:
  /// `shown` [N]: what the sensor still shows of a force that has just ended.
  explicit MotorForce(double current_lag, double shown = 0) EBAC_RT : current_lag_(current_lag),
                                                                      acts_(current_lag),
                                                                      shown_(shown) {}

  void set_tick(double sensor_lag, double dt) EBAC_RT {
    // Lags so close that their partial fractions lose digits are taken apart.
    const bool close = std::abs(sensor_lag - current_lag_) < 1e-3 * current_lag_;
    sensor_lag_ = close ? current_lag_ * 1.001 : sensor_lag;
    acts_.set_tick(dt);
    sensor_ = Transient(sensor_lag_, dt);
    cross_ = current_lag_ > 0 ? current_lag_ / (current_lag_ - sensor_lag_) : 0;
  }

  /// Holds `command` for one interval; returns the mean over it of what is shown.
  double hold(double command) EBAC_RT {
    const double f = (acts_.force() - command) * cross_;
    const double g = shown_ - command;
    const Transient& motor = acts_.left();
    const double mean = command + f * (motor.mean - sensor_.mean) + g * sensor_.mean;
    shown_ = command + f * (motor.end - sensor_.end) + g * sensor_.end;
    acts_.hold(command);
    return mean;
  }

  const LaggedForce& acts() const EBAC_RT { return acts_; }
  double shown() const EBAC_RT { return shown_; }            // N, now
  double sensor_lag() const EBAC_RT { return sensor_lag_; }  // s

 private:
  double current_lag_;  // s
  LaggedForce acts_;
  double sensor_lag_ = 0;  // s
  double shown_;           // N
  Transient sensor_;
  double cross_ = 0;
};

}  // namespace ebac
