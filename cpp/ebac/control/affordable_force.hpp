#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/energy_ledger.hpp"
#include "ebac/control/pending.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// The account (D): what was taken in, and the largest force it covers over any motion, whatever is under way.
///
/// A force F held for one interval gives out at most F^2/(4B); the force now behind the current
/// loop what its decay can; and the position is known to one count, charged at the largest force in
/// play. B = b/T counts with the longest tick a force may act for.
class CoveredForce {
 public:
  CoveredForce(double damping, double count, double current_lag, const Timing& timing) EBAC_RT
      : b_(damping / timing.longest()),
        count_(count),
        ledger_(damping, count, current_lag, /*reserve=*/0),
        pending_(timing.delay) {}

  double energy() const EBAC_RT { return ledger_.energy(); }  // J

  void take(double f_applied, double dx, double dt) EBAC_RT {
    if (dt != dt_) ledger_.set_tick(dt_ = dt);
    ledger_.take(f_applied, dx, dx);
  }

  double largest() const EBAC_RT {
    const double under_way = pending_.sum_of_squares() + ledger_.tail_squared();
    const double spare = ledger_.energy() - under_way / (4 * b_);
    if (!(spare > 0)) return 0;
    const double waiting = pending_.largest_with(0);
    const double alone = 2 * b_ * (std::sqrt(count_ * count_ + spare / b_) - count_);
    if (alone >= waiting) return alone;  // it is itself the largest in play
    return std::min(waiting, 2 * std::sqrt(b_ * std::max(0.0, spare - count_ * waiting)));
  }

  void give(double force) EBAC_RT { pending_.push(force); }

 private:
  double b_;      // N/m
  double count_;  // m
  EnergyLedger ledger_;
  Pending pending_;
  double dt_ = 0;  // s
};

}  // namespace ebac
