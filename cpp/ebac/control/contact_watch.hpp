#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// What a law learns of a contact while it lasts: how steep the environment is, and whether it swings.
class ContactWatch {
 public:
  ContactWatch(double count, double most) EBAC_RT : count_(count), most_(most), stored_at_(most) {}

  double slope() const EBAC_RT { return slope_; }  // N/m, 0 out of contact
  double pace() const EBAC_RT { return pace_; }    // 1; falls with every reversal of a swing

  /// Stiffness the last contact can have stored energy at [N/m]: its slope, at most what the law shows.
  double stored_at() const EBAC_RT { return stored_at_; }

  /// Takes one tick; `direction` is that of the motion beyond one count: -1, 0, +1.
  void watch(const Port& port, int direction) EBAC_RT {
    if (port.f_env == 0) {
      slope_ = clock_ = 0;
      pace_ = 1;
    } else {
      clock_ += port.dt;
      if (std::abs(port.dx) > count_ / 2) learn(port);  // less, on a slant, is mostly rounding
    }
    last_env_ = port.f_env;
    if (direction == 0) return;
    if (direction == -heading_ && clock_ > kImpact) pace_ = std::max(kSlowest, kSlower * pace_);
    heading_ = direction;
  }

 private:
  // Chosen with the constants of Ebac.
  static constexpr double kForget = 0.02;  // per moving tick, of a slope steeper than the last
  static constexpr double kImpact = 0.5;   // s after contact in which reversals are no swing
  static constexpr double kSlower = 0.9;   // pace, per reversal after that
  static constexpr double kSlowest = 0.3;

  void learn(const Port& port) EBAC_RT {
    const double seen = std::abs((port.f_env - last_env_) / port.dx);
    slope_ = seen > slope_ ? seen : slope_ + kForget * (seen - slope_);
    stored_at_ = std::min(most_, slope_);
  }

  double count_;  // m
  double most_;   // N/m
  double stored_at_;
  double slope_ = 0;
  double pace_ = 1;
  double clock_ = 0;     // s in contact
  double last_env_ = 0;  // N
  int heading_ = 0;      // direction of the last motion
};

}  // namespace ebac
