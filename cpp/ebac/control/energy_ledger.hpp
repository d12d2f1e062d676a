#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/lagged_force.hpp"
#include "ebac/control/observed_work.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// Energy that the virtual side has taken in and may give back: E += F_bar s + B max(|dx| - count,
/// 0)^2, with F_bar the mean force behind the current loop, s the best estimate of the
/// displacement, dx its reading, and B = b/T. Updated before any decision of the tick.
///
/// An account that only grows would later pay for any instability, so it leaks, slowly, towards the
/// energy that the last contact can have stored.
///
/// Where the surface of the virtual world moves and declares it, its own work is not the law's: -F_w dp
/// with the way dp of the surface and the part F_w of the mean force, at most what the world had
/// asked for. The account is then of F_bar s - F_w dp.
class EnergyLedger {
 public:
  EnergyLedger(double damping, double count, double current_lag, double reserve) EBAC_RT
      : damping_(damping),
        count_(count),
        lag_(current_lag),
        reserve_(reserve),
        energy_(reserve),
        lagged_(current_lag) {}

  double energy() const EBAC_RT { return energy_; }  // J
  const LaggedForce& lagged() const EBAC_RT { return lagged_; }

  /// Energy that the force now behind the current loop can still give out as it decays, lag f^2 /
  /// (4 b), as the square of a force held for one interval [N^2].
  double tail_squared() const EBAC_RT { return lag_ * lagged_.force() * lagged_.force() / dt_; }

  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    b_ = damping_ / dt;
    lagged_.set_tick(dt);
    leak_share_ = dt / (kLeakTime + dt);
    leak_keep_ = std::exp(-dt / kLeakTime);
  }

  /// `world` is the way of the world's surface over the interval [m], `asked` its force [N].
  void take(double f_applied, double moved, double dx, double world = 0, double asked = 0) EBAC_RT {
    const double sure = std::max(std::abs(dx) - count_, 0.0);
    mean_ = lagged_.hold(f_applied);
    energy_ += mean_ * moved + b_ * sure * sure - of_world(mean_, asked) * world;
  }

  /// The same, and proven: a reading errs by half a count, so the sum by as much for all that the mean force changes
  /// by (summation by parts); and a velocity that varies within the tick meets a force that does.
  void take_proven(double f_applied, double dx) EBAC_RT {
    energy_ -= lagged_.spread(f_applied) / (4 * damping_);
    const double before = mean_;
    take(f_applied, dx, dx);
    energy_ -= 0.5 * count_ * std::abs(mean_ - before);
  }

  /// The same with the observer's position.
  void take(const Port& port, ObservedWork& work, double world, double asked) EBAC_RT {
    const double moment = lagged_.moment(port.f_applied);
    const double mean = lagged_.hold(port.f_applied);
    energy_ += work.step(mean, moment, port, b_) - of_world(mean, asked) * world;
  }

  /// From now on `reserve` [J] is lent in all. More is added at once; less is taken back as far as
  /// the account holds more than `reserve`.
  void lend(double reserve) EBAC_RT {
    if (reserve == reserve_) return;
    double change = reserve - reserve_;
    if (change < 0) change = -std::min(-change, std::max(0.0, energy_ - reserve));
    energy_ += change;
    reserve_ += change;
  }

  /// What it holds beyond its reserve [J], and another such amount for it.
  double surplus() const EBAC_RT { return energy_ - reserve_; }
  void settle(double surplus) EBAC_RT { energy_ = reserve_ + surplus; }

  /// Begins anew, and owes what is missing to what a contact stores [J].
  void begin(double stored) EBAC_RT {
    energy_ = std::max(energy_, reserve_);
    owed_ = std::max(0.0, reserve_ + stored - energy_);
  }
  /// A contact stores `more` [J] than before, with no motion: it is owed, and paid at once as far as the reserve is
  /// drawn on. Less is taken back, but not the reserve.
  void store(double more) EBAC_RT {
    owed_ += more;
    const double at_once = owed_ > 0 ? std::min(owed_, std::max(0.0, reserve_ - energy_))
                                     : -std::min(-owed_, std::max(0.0, energy_ - reserve_));
    energy_ += at_once;
    owed_ = std::max(0.0, owed_ - at_once);
  }
  /// What is missing to what a contact stores is owed, at most `most` [J].
  void owe(double stored, double most) EBAC_RT {
    owed_ = std::max(owed_, std::min(most, reserve_ + stored - energy_));
  }
  double owed() const EBAC_RT { return owed_; }  // J
  /// Pays a part of what it owes: so slowly that nothing is thrown.
  void pay() EBAC_RT {
    const double part = std::min(owed_, kPay * dt_);
    energy_ += part;
    owed_ -= part;
  }
  void forgive() EBAC_RT { owed_ = 0; }

  /// Charges a force that changes while no motion is seen, one count of it: past the edge crossed
  /// last the device may have gone that far before it turns. What is not given after all is taken
  /// back by a `size` below zero.
  void charge_unseen(double size) EBAC_RT { energy_ -= count_ * size; }

  /// Leaks towards reserve + F_peak^2 / stiffness, with F_peak the largest command of about a
  /// second.
  void leak(double command, double stiffness) EBAC_RT {
    peak_ = std::max(std::abs(command), peak_ * leak_keep_);
    const double excess = (energy_ - reserve_) * stiffness - peak_ * peak_;
    if (excess > 0) energy_ -= excess / stiffness * leak_share_;
  }

 private:
  static double of_world(double mean, double asked) EBAC_RT {
    return std::clamp(mean, std::min(asked, 0.0), std::max(asked, 0.0));
  }

  static constexpr double kLeakTime = 1.0;  // s
  static constexpr double kPay = 0.1;       // W

  double damping_;
  double count_;
  double lag_;
  double reserve_;
  double energy_;
  LaggedForce lagged_;
  double mean_ = 0;  // N, over the last interval
  double owed_ = 0;  // J
  double peak_ = 0;  // N
  double dt_ = 1;    // s
  double b_ = 0;     // N/m, B = b/T
  double leak_share_ = 0;
  double leak_keep_ = 1;
};

}  // namespace ebac
