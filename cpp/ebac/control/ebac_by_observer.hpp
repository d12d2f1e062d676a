#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/ebac_shared.hpp"
#include "ebac/control/motion_guard.hpp"
#include "ebac/control/observed_force.hpp"
#include "ebac/control/observed_work.hpp"
#include "ebac/core/observer_count.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// The way of `Ebac` from the observer's estimate to a command: nothing is left for eq. (8) to (10)
/// to bound or recover.
class EbacByObserver {
 public:
  EbacByObserver(const EbacParams& params, const Timing& timing) EBAC_RT
      : force_(params, timing),
        work_(params.count, observer_count(params.count, params.mass, timing.dt),
              params.force_noise),
        guard_(params.damping, params.mass,
               observer_count(params.count, params.mass, timing.dt) / 2, timing.longest(), kKnown) {
  }

  void retune(const EbacByObserver& next) EBAC_RT { force_.retune(next.force_); }

  /// The account begins with this tick.
  void begin(const Port& port) EBAC_RT { work_.start(port); }

  /// Whether the account is too low for the whole force, or holds less than half of its reserve or than a spring
  /// would give back, and without the observer more would be lent.
  bool drained(const EbacShared& shared) const EBAC_RT {
    const double stored = force_.stored(shared.f_env);
    const double least = std::max(kLow * shared.params.observed_reserve, stored);
    if (shared.state.admitted >= 1 && shared.ledger.energy() >= least) return false;
    return shared.reserve_at_rest() > shared.params.observed_reserve;
  }

  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT { force_.shift(change); }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT { force_.scale(by); }

  /// Nothing is known of the contact.
  void forget() EBAC_RT { force_.forget(); }

  /// Stiffness at which the last contact can have stored energy [N/m].
  double stored_at() const EBAC_RT { return force_.stored_at(); }

  /// Steps 2 to 6 alone.
  double force(const Port& port, const EbacShared& shared) EBAC_RT {
    force_.meet(port);
    return met(port, shared);
  }

  /// Steps 1 to 6: the force that is wanted.
  double step(const Port& port, EbacShared& shared) EBAC_RT {
    force_.meet(port);
    shared.ledger.take(port, work_, shared.surface(port), shared.asked[0]);
    shared.ledger.lend(shared.params.observed_reserve);
    const double wanted = met(port, shared);
    shared.state.slope = force_.slope();
    shared.state.f_d = shared.held(force_.shown());
    shared.state.injected = force_.injected();
    shared.state.record(0, 0, 0, 0);
    return wanted;
  }

  /// Step 7, with the velocity of the observer, half a count, and the pull that the force sensor
  /// shows, behind its lag: a hand may vanish at any time, but its pull grows no faster than declared.
  double guarded(double wanted, const Port& port, EbacShared& shared) const EBAC_RT {
    if (!shared.params.guard || wanted == 0) return wanted;
    const double pull = shared.pull_shown(wanted, port);
    const double v = port.est.v;
    const double energy = shared.ledger.energy();
    if (guard_.surely_admits(wanted, shared.in_flight, shared.ledger.lagged(), energy,
                             std::abs(v) * port.dt, pull, port.world_v)) {
      return wanted;
    }
    const double command = guard_.admit(wanted, shared.in_flight, shared.ledger.lagged(), energy, v,
                                        pull, port.world_v);
    if (command != wanted) shared.limited(command, wanted);
    return command;
  }

 private:
  /// The force of the world that was met.
  double met(const Port& port, const EbacShared& shared) EBAC_RT {
    return shared.held(force_.force(port, shared.ledger.energy()));
  }

  static constexpr double kKnown = 0.5;  // of a jump: the velocity is that at the interval's start
  static constexpr double kLow = 0.5;    // of the reserve

  ObservedForce force_;
  ObservedWork work_;
  MotionGuard guard_;
};

}  // namespace ebac
