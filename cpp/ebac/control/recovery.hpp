#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// How fast F_d relaxes towards F_e where dx = 0 and eq. (9) is undefined: with the time constant
/// T_r / pace * (K / c_h - 1), for a wall of slope K.
class Recovery {
 public:
  /// T_r [s] for a `mass` on a damper: a pace against what the damper brings to rest.
  static double time(double mass, double damping) EBAC_RT { return mass * kPace / damping; }

  Recovery(double time, double stiffness) EBAC_RT : time_(time), stiffness_(stiffness) {}

  /// Share of the way that one tick goes. Its divisions follow one from the other, and a tick would
  /// wait for them; so they are done when the contact has changed, which it does in motion.
  double share(double slope, double pace, double dt) EBAC_RT {
    if (slope != slope_ || pace != pace_ || dt != dt_) {
      slope_ = slope;
      pace_ = pace;
      dt_ = dt;
      const double time = time_ / pace * std::max(slope / stiffness_ - 1, kLeastExcess);
      share_ = dt / (time + dt);
    }
    return share_;
  }

 private:
  // Chosen on a grid of 60 hands and 36 cells of delay, damping and stiffness; `ebac study` runs it.
  static constexpr double kPace = 2.2;
  static constexpr double kLeastExcess = 0.25;  // of K/c_h - 1: recovery of a wall as soft as c_h

  double time_;       // s, T_r
  double stiffness_;  // N/m, c_h
  double slope_ = 0;  // N/m
  double pace_ = 0;
  double dt_ = 0;  // s; no tick has it
  double share_ = 0;
};

}  // namespace ebac
