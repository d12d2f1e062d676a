#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// When a law gives the observer up because its energy account runs out: in a contact at rest that the account could pay
/// for at first. There the force follows the noise of the sensor and the account is charged for it, while by the
/// encoder, whose reading does not change, a resting wall costs nothing.
///
/// It ends as soon as the hand moves or shakes, or leaves: a hand that shakes the account empty could draw more by the
/// encoder alone. A fast shake shows in the force only.
class AccountWatch {
 public:
  /// What a tick shows of all axes.
  struct Tick {
    bool drained = false;  // the account is low
    bool contact = false;
    double speed = 0;  // m/s, of the fastest
    double rough = 0;  // largest share of ticks in which the force bends more than by its noise
  };

  bool given_up() const EBAC_RT { return given_up_; }

  void step(const Tick& now, double dt) EBAC_RT {
    if (dt != dt_) set_tick(dt);
    speed_ += (now.speed - speed_) * averaging_;
    if (!now.contact) paid_ = std::max(0.0, paid_ - dt);
    const bool shakes = now.rough > (given_up_ ? kShaken : kShakes);
    if (speed_ > kMoves || shakes || !now.contact) {
      given_up_ = false;
      drained_ = 0;
    } else if (!now.drained) {
      paid_ += dt;
      drained_ = std::max(0.0, drained_ - dt);
    } else if (paid_ > kPaid) {
      drained_ += dt;
      given_up_ = given_up_ || drained_ > kDrained;
    }
  }

 private:
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    averaging_ = dt / (kMean + dt);
  }

  static constexpr double kMoves = 0.01;                  // m/s
  static constexpr double kMean = 0.1;                    // s, over which the speed is smoothed
  static constexpr double kShakes = 0.02, kShaken = 0.2;  // of the ticks: prevents it, ends it
  static constexpr double kPaid = 0.3;  // s of rest in this contact that the account has paid for
  static constexpr double kDrained = 0.2;  // s

  double dt_ = 0;         // s
  double averaging_ = 0;  // share taken, per tick
  double speed_ = 0;      // m/s
  double paid_ = 0;       // s
  double drained_ = 0;    // s
  bool given_up_ = false;
};

}  // namespace ebac
