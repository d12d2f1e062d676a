#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// What two readings of an encoder prove of the velocity: its mean between them within a count. Now it may be off by
/// half of what that mean changes by, each to a count. An estimate may be beyond that for 3.5 ms: where motor and handle
/// ring on a cable, the sign of what it is off by alternates sooner; a force that is wrong by far leads it on.
class ProvenVelocity {
 public:
  /// `count` [m], of the encoder.
  explicit ProvenVelocity(double count) EBAC_RT : count_(count) {}

  void start(double reading) EBAC_RT {
    reading_ = reading;
    mean_ = unread_ = astray_ = 0;
  }
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    per_dt_ = 1 / dt;
  }
  void pass(double dt) EBAC_RT { unread_ += dt; }

  double reading() const EBAC_RT { return reading_; }  // m, the last one
  double unread() const EBAC_RT { return unread_; }    // s, since then

  /// Takes a reading [m] and the estimate `v` [m/s]; returns how far that is beyond what is proven [m/s].
  double take(double reading, double v) EBAC_RT {
    const double per_time = unread_ == dt_ ? per_dt_ : 1 / unread_;
    const double mean = (reading - reading_) * per_time;
    const double unsure = 2 * count_ * per_time + 0.5 * std::abs(mean - mean_);
    const double off = v - std::clamp(v, mean - unsure, mean + unsure);
    const double less = std::copysign(std::max(0.0, std::abs(astray_) - unread_), astray_);
    astray_ = off == 0 ? less : (off * astray_ < 0 ? 0.0 : astray_) + std::copysign(unread_, off);
    reading_ = reading;
    mean_ = mean;
    unread_ = 0;
    return off;
  }

  /// Whether the estimate has been beyond it for too long.
  bool refuted() const EBAC_RT { return std::abs(astray_) > kPatience; }

 private:
  static constexpr double kPatience = 3.5e-3;  // s, half a period of a cable's resonance of 140 Hz

  double count_;        // m
  double reading_ = 0;  // m
  double unread_ = 0;   // s
  double mean_ = 0;     // m/s, between the last two
  double astray_ = 0;   // s, that an estimate has been beyond it, with the sign of its error
  double dt_ = 0;       // s, argument of the last set_tick
  double per_dt_ = 0;   // 1/s
};

}  // namespace ebac
