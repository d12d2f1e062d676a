#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// Estimates the slope and the damping of the environment and detects oscillation, for as long as a contact lasts.
class ContactEstimator {
 public:
  ContactEstimator(double count, double most) EBAC_RT : count_(count),
                                                        most_(most),
                                                        stored_at_(most) {}

  double slope() const EBAC_RT { return slope_; }      // N/m, without damping; 0 out of contact
  double damping() const EBAC_RT { return damping_; }  // N s/m, 0 where unknown

  /// The slope from one rest to another, free of the damping of the environment.
  double slope_at_rest() const EBAC_RT { return std::min(slope_, rest_slope_); }
  double pace() const EBAC_RT { return pace_; }  // 1; falls with every reversal of a swing

  /// Stiffness at which the last contact can have stored energy [N/m]: its slope, at most the law's.
  double stored_at() const EBAC_RT { return stored_at_; }

  /// Begins in a contact: the force of this tick is no change.
  void begin(const Port& port) EBAC_RT {
    last_env_ = port.f_env;
    last_v_ = port.v;
  }

  /// The forces seen so far have changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    if (last_env_ == 0) return;
    last_env_ += change;
    here_.force += change;
    there_.force += change;
  }

  /// The contact has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    for (double* of :
         {&last_env_, &slope_, &damping_, &last_seen_, &rest_slope_, &here_.force, &there_.force}) {
      *of *= by;
    }
    if (slope_ > 0) stored_at_ = std::min(most_, slope_);
  }

  /// Takes one tick; `direction` is that of the motion beyond one count: -1, 0, +1.
  void watch(const Port& port, int direction) EBAC_RT {
    if (port.f_env == 0) {
      slope_ = damping_ = last_seen_ = clock_ = 0;
      pace_ = 1;
      rest_slope_ = std::numeric_limits<double>::infinity();
      here_ = there_ = {};
    } else {
      clock_ += port.dt;
      learn_damping(port);
      if (std::abs(port.dx) > count_ / 2) learn(port);  // less, on a slant, is mostly rounding
    }
    last_env_ = port.f_env;
    last_v_ = port.v;
    rest(port);
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

  /// While the position stands, the force of a world at rest changes with the velocity alone. Of two such changes the
  /// one that shows less damping counts: what else changes a force does so once.
  void learn_damping(const Port& port) EBAC_RT {
    const double dv = port.v - last_v_;
    const bool stands = port.dx == 0 && port.world_v == 0 && port.est.weight == 0;
    if (!stands || dv == 0 || last_env_ == 0) return;
    const double seen = std::max(0.0, (port.f_env - last_env_) / dv);
    damping_ = std::min(seen, last_seen_);
    last_seen_ = seen;
  }

  void learn(const Port& port) EBAC_RT {
    const double change = port.f_env - last_env_ - damping_ * (port.v - last_v_);
    const double seen = std::abs(change / port.dx);
    slope_ = seen > slope_ ? seen : slope_ + kForget * (seen - slope_);
    stored_at_ = std::min(most_, slope_);
  }

  /// Compares the ends of two rests: by then no velocity is left in the force.
  void rest(const Port& port) EBAC_RT {
    if (port.dx == 0) {
      here_ = {port.x, port.f_env - damping_ * port.v, port.f_env != 0};
    } else if (here_.known) {
      if (there_.known && std::abs(here_.x - there_.x) > count_ / 2) {
        rest_slope_ = std::abs((here_.force - there_.force) / (here_.x - there_.x));
      }
      there_ = std::exchange(here_, {});
    }
  }

  /// A place at which the device was still, in contact.
  struct Rest {
    double x = 0;      // m
    double force = 0;  // N
    bool known = false;
  };

  double count_;  // m
  double most_;   // N/m
  double stored_at_;
  double slope_ = 0;
  double damping_ = 0;    // N s/m
  double last_seen_ = 0;  // N s/m
  double pace_ = 1;
  double clock_ = 0;     // s in contact
  double last_env_ = 0;  // N
  double last_v_ = 0;    // m/s
  double rest_slope_ = std::numeric_limits<double>::infinity();
  Rest here_{};      // this rest, or none
  Rest there_{};     // the one before
  int heading_ = 0;  // direction of the last motion
};

}  // namespace ebac
