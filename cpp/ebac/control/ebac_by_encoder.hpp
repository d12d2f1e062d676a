#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/contact_estimator.hpp"
#include "ebac/control/ebac_shared.hpp"
#include "ebac/control/force_feedback.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/control/motion_guard.hpp"
#include "ebac/control/recovery.hpp"
#include "ebac/control/sub_count_position.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/model/velocity.hpp"

namespace ebac {

/// The way of `Ebac` from the encoder's readings to a command: its steps 1 to 7.
///
/// F_d follows the environment without its damping, which the damper of step 5 stands for: the velocity of one count a
/// tick is 31 mm/s, and what it takes from the force outwards at once, recovery would give back slowly.
class EbacByEncoder {
 public:
  EbacByEncoder(const EbacParams& params, const Timing& timing) EBAC_RT
      : show_(params.mass, params.count, params.current_lag, timing, params.resonance),
        recovery_(Recovery::time(params.heaviest_hand + params.mass, show_.damping),
                  show_.stiffness),
        loop_(params.kp, params.kd, params.filter),
        sub_count_(params.count),
        damper_(show_),
        contact_(params.count, show_.stiffness),
        guard_(params.damping, params.mass, params.count, timing.longest()) {}

  void set_tick(double dt) EBAC_RT { damper_.set_tick(dt); }

  void begin(const Port& port) EBAC_RT {
    sub_count_.start(port.x);
    readings_.push(port.x, 0);
  }

  /// Begins anew where the observer goes; the interval up to now is still to be taken.
  void take_over(const Port& port, const EbacParams& params) EBAC_RT {
    sub_count_.start(port.x - port.dx);
    damper_.reset();
    loop_.reset();
    readings_.clear();
    contact_ = ContactEstimator(params.count, show_.stiffness);
    contact_.begin(port);
    ratio_ = 0;
  }

  void retune(const EbacParams& params, const EbacByEncoder& next) EBAC_RT {
    loop_.retune(params.kp, params.kd, params.filter);
    recovery_ = next.recovery_;
  }

  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT { contact_.shift(change); }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT { contact_.scale(by); }

  /// Stiffness at which the last contact can have stored energy [N/m].
  double stored_at() const EBAC_RT { return contact_.stored_at(); }

  /// Steps 1 to 6: the force that is wanted.
  double step(const Port& port, EbacShared& shared) EBAC_RT {
    recovered_ = 0;
    lend(port, shared);
    shared.ledger.take(port.f_applied, sub_count_.step(port.x, port.dt), port.dx,
                       shared.surface(port),
                       shared.asked[0]);  // 1
    const double damping = damper_.step(port.dx);
    readings_.push(port.x, time_ += port.dt);
    contact_.watch(port, sub_count_.direction());
    shared.state.slope = contact_.slope();
    spring_ = spring(port);
    if (port.f_env == 0) return release(shared);  // 4
    if (port.dx != 0) {
      move(port, shared);  // 2
    } else if (shared.params.recovery) {
      recover(port, shared);  // 3
    }
    shared.state.f_d = shared.held(shared.state.f_d);
    return complete(port, damping, shared);  // 5, 6
  }

  /// Step 7: what the ledger can pay for, of that.
  double guarded(double wanted, const Port& port, EbacShared& shared) EBAC_RT {
    if (!shared.params.guard) return wanted;
    const double energy = to_spend(wanted, port, shared);
    const double step =
        std::abs(port.dx) + shared.params.count;  // no window slopes by more than this
    const double pull = at_rest(port) ? shared.pull_shown(wanted, port) : shared.params.pull;
    if (guard_.surely_admits(wanted, shared.in_flight, shared.ledger.lagged(), energy, step, pull,
                             /*surface=*/0)) {
      return wanted;
    }
    const double v = adaptive_slope(readings_, kWindow, shared.params.count);
    const double command = guard_.admit(wanted, shared.in_flight, shared.ledger.lagged(), energy, v,
                                        pull, /*surface=*/0);
    if (command != wanted) {
      shared.limited(command, wanted);
      take_back(command, shared);
      const double size = std::abs(command);
      if (std::abs(shared.state.f_d) > size) {
        shared.state.f_d += (std::copysign(size, shared.state.f_d) - shared.state.f_d) * port.dt /
                            (kYield + port.dt);
      }
    }
    return command;
  }

 private:
  // Chosen on a grid of 60 hands and 36 cells of delay, damping and stiffness; `ebac study` runs it.
  static constexpr double kFloor = 0.5;   // of c_h: slope that continuity always allows
  static constexpr double kYield = 0.01;  // s, F_d follows a command the guard holds back
  static constexpr int kWindow = 16;      // samples, velocity the guard counts with

  /// What the ledger has for the guard, which here knows no velocity that lets it see a hand follow: a surface that
  /// yields takes its share of the energy until the command has acted.
  static double to_spend(double wanted, const Port& port, const EbacShared& shared) EBAC_RT {
    const double yields = std::copysign(port.world_v, port.world_v * wanted);
    if (!(yields > 0)) return shared.ledger.energy();
    const double time = (shared.timing.delay + 1) * port.dt + shared.params.current_lag;
    return shared.ledger.energy() - shared.in_flight.largest_with(wanted) * yields * time;
  }

  /// The observer was given up for the account, in a contact at rest.
  static bool at_rest(const Port& port) EBAC_RT {
    return port.est.fallback == static_cast<int>(Fallback::kAccount);
  }

  /// On the encoder alone the account needs a larger reserve. While the estimate fades in, nothing is added.
  static void lend(const Port& port, EbacShared& shared) EBAC_RT {
    if (port.est.fallback == static_cast<int>(Fallback::kNone)) return;
    shared.ledger.lend(at_rest(port) ? shared.reserve_at_rest() : shared.params.reserve);
  }

  /// Eq. (2), without the force loop while the observer finds the sensor stale or failing, or its readings against the
  /// model: one that is late is. Without an observer it is the limits of the loop that end a run whose sensor fails.
  double feedback(double desired, const Port& port) EBAC_RT {
    const auto fallback = static_cast<Fallback>(port.est.fallback);
    const bool doubted = fallback == Fallback::kForceStale || fallback == Fallback::kForceStatus ||
                         fallback == Fallback::kModel;
    if (!doubted) return loop_.step(desired, port.f_meas, port.dt);
    loop_.reset();
    return 0;
  }

  /// The force of the environment without its damping.
  double spring(const Port& port) const EBAC_RT {
    const double force = port.f_env - contact_.damping() * port.v;
    return port.f_env > 0 ? std::max(force, 0.0) : std::min(force, 0.0);
  }

  double release(EbacShared& shared) EBAC_RT {
    shared.state.f_d = shared.state.injected = 0;
    ratio_ = 0;
    loop_.reset();
    shared.state.record(0, 0, 0, 0);
    return 0;
  }

  void move(const Port& port, EbacShared& shared) EBAC_RT {
    const double dx = port.dx;
    const double before = shared.state.f_d;
    double rise = spring_ - before;  // eq. (9): beta dx
    const bool releasing = before * dx < 0 && std::abs(spring_) < std::abs(before);
    if (shared.params.continuity && !releasing) {
      const double least = kFloor * show_.stiffness * std::abs(dx);  // the floor
      const double grown = shared.params.growth * ratio_ * dx;       // eq. (10), rows 3 and 4,
      const double decayed = shared.params.decay * ratio_ * dx;      // sorted
      rise =
          std::clamp(rise, std::min({grown, decayed, -least}), std::max({grown, decayed, least}));
    }
    const double bound = std::abs(before + show_.stiffness * dx);  // eq. (10), rows 1 and 2: last
    shared.state.f_d = std::clamp(before + rise, -bound, bound);   // eq. (8)
    shared.state.clamped = shared.state.f_d != before + rise;
    shared.state.record(before, shared.state.f_d, dx, bound);
    ratio_ = shared.state.beta;
  }

  void recover(const Port& port, EbacShared& shared) EBAC_RT {
    const double slope = contact_.slope_at_rest();
    const double open = 0.5 * slope * shared.params.count;  // uncertainty of a reading
    const double off = spring_ - shared.state.f_d;
    const double sure = std::max(off - open, 0.0) + std::min(off + open, 0.0);
    const double change = sure * recovery_.share(slope, contact_.pace(), port.dt);
    shared.ledger.charge_unseen(std::abs(change));
    recovered_ = change;
    shared.state.f_d += change;
    shared.state.record(0, 0, 0, 0);
  }

  double complete(const Port& port, double damping, EbacShared& shared) EBAC_RT {
    double desired = shared.state.f_d;
    shared.state.injected = 0;
    if (shared.params.injection) {
      desired += damping;
      desired = port.f_env > 0 ? std::max(desired, 0.0) : std::min(desired, 0.0);  // never sticks
      shared.state.injected = desired - shared.state.f_d;
    }
    const double total = desired + feedback(desired, port);
    return shared.held(total);
  }

  /// A force that the guard does not give is not charged.
  void take_back(double command, EbacShared& shared) EBAC_RT {
    const double asked = std::abs(recovered_);
    const double given = std::copysign(1.0, recovered_) * (command - shared.command);
    shared.ledger.charge_unseen(std::clamp(given, 0.0, asked) - asked);
  }

  Injection show_;  // stiffness and damping that the device can render in motion
  Recovery recovery_;
  ForceFeedback loop_;
  SubCountPosition sub_count_;
  Damper damper_;
  ContactEstimator contact_;
  MotionGuard guard_;
  Readings readings_{};
  double time_ = 0;       // s
  double ratio_ = 0;      // N/m, beta(t-1)
  double spring_ = 0;     // N, of the environment
  double recovered_ = 0;  // N, change of F_d by recovery in this tick
};

}  // namespace ebac
