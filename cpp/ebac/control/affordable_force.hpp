#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/control/energy_ledger.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// The account (D): energy taken in, and the largest force it can pay for over any motion, with all
/// commands in flight. Proven on one axis: what readings can be wrong by is charged (`take_proven`).
/// The error of the reading at the instant itself is not: half a count times the force of the last tick.
/// Along a direction oblique to n axes the errors of n readings add up: `count` is then sqrt(n) counts.
///
/// A force F held for one interval gives out at most F^2/(4B); the force now behind the current
/// loop at most the energy of its decay; and the position is known to one count, charged at the
/// largest force in play. B = b/T uses the longest tick for which a force may act.
class AffordableForce {
 public:
  AffordableForce(double damping, double count, double current_lag, const Timing& timing) EBAC_RT
      : b_(damping / timing.longest()),
        count_(count),
        ledger_(damping, count, current_lag, /*reserve=*/0),
        in_flight_(timing.delay) {}

  double energy() const EBAC_RT { return ledger_.energy(); }  // J

  void take(double f_applied, double dx, double dt) EBAC_RT {
    if (dt != dt_) ledger_.set_tick(dt_ = dt);
    ledger_.take_proven(f_applied, dx);
  }

  double largest() const EBAC_RT {
    const double under_way = in_flight_.sum_of_squares() + ledger_.tail_squared();
    const double spare = ledger_.energy() - under_way / (4 * b_);
    if (!(spare > 0)) return 0;
    const double waiting = in_flight_.largest_with(0);
    const double alone = 2 * b_ * (std::sqrt(count_ * count_ + spare / b_) - count_);
    if (alone >= waiting) return alone;  // it is itself the largest in play
    return std::min(waiting, 2 * std::sqrt(b_ * std::max(0.0, spare - count_ * waiting)));
  }

  void give(double force) EBAC_RT { in_flight_.push(force); }

 private:
  double b_;      // N/m
  double count_;  // m
  EnergyLedger ledger_;
  CommandsInFlight in_flight_;
  double dt_ = 0;  // s
};

}  // namespace ebac
