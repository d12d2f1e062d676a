#pragma once

#include <algorithm>
#include <string_view>

#include "ebac/control/ebac_by_encoder.hpp"
#include "ebac/control/ebac_by_observer.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/ebac_shared.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// The closed-loop energy-bounding algorithm, completed: eq. (8) to (10) while the device moves,
/// with the points completed that the paper leaves open. In the order of `step`:
///
///   1. ledger      the energy the virtual side holds, on the force really applied
///   2. motion      eq. (9), the continuity of eq. (10), and the bound last: at most c_h
///   3. recovery    where dx = 0 and eq. (9) is undefined, F_d relaxes to F_e
///   4. release     contact lost: F_d = 0, always admissible
///   5. damping     B_v on a play-filtered velocity, as large as mass and delay allow
///   6. force loop  eq. (2), with a small K_p
///   7. guard       the total command is limited to what the ledger can pay for
///
/// With the observer (`Scenario(observer=...)`), 1 is counted within a count, 2 to 6 become
/// F = F_e + B_v v at the state predicted for the instant at which the command acts, small fast
/// changes of F_e softer while the account is rich (`DynamicStiffness`), and 7 counts with the
/// velocity and the pull that are measured. Where the observer fails, the law fades to the
/// steps above in 20 ms, from the force it is at.
///
/// The design uses no property of the wall or the hand.
class Ebac {
 public:
  static constexpr std::string_view kName = "ebac";
  static constexpr std::string_view kSummary =
      "observer, damper, energy account; without the observer eq. (2), (8) to (10), completed";
  static constexpr bool kPassive = false;  // guarded; see docs/explanation/theory.md

  using Params = EbacParams;
  using State = EbacState;

  explicit Ebac(const Params& params, const Timing& timing = {})
      : shared_(checked(params, "EBAC"), checked(timing, "Timing")),
        encoder_(params, timing),
        observer_(params, timing) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return begin(port);
    if (port.dt != dt_) set_tick(port.dt);
    if (port.est.weight != weight_) hand_over(port);
    if (shared_.ledger.owed() > 0) pay(port);
    shared_.watch_hand(port);
    shared_.state.clamped = false;
    shared_.state.admitted = 1;
    double command = 0;
    if (weight_ < 1) {
      double wanted = encoder_.step(port, shared_);
      if (weight_ > 0) wanted += weight_ * (observer_.force(port, shared_) - wanted);
      command = encoder_.guarded(wanted, port, shared_);
    } else {
      command = observer_.guarded(observer_.step(port, shared_), port, shared_);
    }
    shared_.give(command, port, stored_at());
    return command;
  }

  /// After this law has taken over from another: the account begins anew and is raised to what this contact stores,
  /// while it lasts.
  void begin_account() EBAC_RT { shared_.ledger.begin(stored()); }
  /// Of what this contact stores, `part` has come in this tick with no motion, as another world takes over or the force
  /// comes in; below zero where it stored more before. At the end, when `in_all` has come, that much of what the account
  /// lacks is owed.
  void store(double part, double in_all) EBAC_RT {
    shared_.ledger.store(part * stored());
    if (in_all > 0) shared_.ledger.owe(stored(), in_all * stored());
  }
  /// What the account holds beyond its reserve [J], and another such amount for it.
  double surplus() const EBAC_RT { return shared_.ledger.surplus(); }
  void settle(double surplus) EBAC_RT { shared_.ledger.settle(surplus); }
  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    encoder_.shift(change);
    observer_.shift(change);
    if (shared_.state.f_d != 0) shared_.state.f_d += change;
  }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    encoder_.scale(by);
    observer_.scale(by);
    shared_.state.f_d *= by;
  }
  void retune(const Ebac& next) EBAC_RT {
    shared_.params = next.params();
    encoder_.retune(next.params(), next.encoder_);
    observer_.retune(next.observer_);
  }
  void reset() EBAC_RT {
    const EbacParams params = shared_.params;
    const Timing timing = shared_.timing;
    shared_ = EbacShared(params, timing);
    encoder_ = EbacByEncoder(params, timing);
    observer_ = EbacByObserver(params, timing);
    dt_ = weight_ = 0;
  }

  const State& state() const EBAC_RT { return shared_.state; }
  double starved() const EBAC_RT { return shared_.state.starved; }
  /// Whether the account is low with the observer, as under a sensor whose noise it cannot pay for.
  bool drained() const EBAC_RT { return weight_ >= 1 && observer_.drained(shared_); }
  const Params& params() const EBAC_RT { return shared_.params; }
  /// Whether it uses the observer's estimate where a run has one.
  bool observed() const EBAC_RT { return shared_.params.observer; }
  const Timing& timing() const EBAC_RT { return shared_.timing; }

 private:
  void pay(const Port& port) EBAC_RT {
    if (port.f_env == 0) return shared_.ledger.forgive();
    shared_.ledger.pay();
    if (shared_.ledger.owed() > 0) shared_.state.starved = 0;
  }

  double stored() const EBAC_RT { return shared_.f_env * shared_.f_env / (2 * stored_at()); }  // J

  double stored_at() const EBAC_RT {
    return weight_ < 1 ? encoder_.stored_at() : observer_.stored_at();
  }

  double begin(const Port& port) EBAC_RT {
    encoder_.begin(port);
    observer_.begin(port);
    if (port.est.weight >= 1) shared_.ledger.lend(shared_.params.observed_reserve);
    shared_.state.energy = shared_.ledger.energy();
    shared_.world_v = port.world_v;
    shared_.f_meas = port.f_meas;
    return 0;
  }

  /// Values that depend on the time since the last tick alone.
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    shared_.set_tick(dt);
    encoder_.set_tick(dt);
  }

  /// The observer comes or goes: what takes over starts where the other is. While it comes, the world is met
  /// elsewhere in every tick. The encoder's part needs a larger reserve.
  void hand_over(const Port& port) EBAC_RT {
    const double weight = port.est.weight;
    if (weight_ >= 1 && weight < 1) encoder_.take_over(port, shared_.params);
    if (weight_ < 1 && weight >= weight_) observer_.forget();
    if (weight_ < 1 && weight >= 1) observer_.begin(port);
    weight_ = weight;
  }

  EbacShared shared_;
  EbacByEncoder encoder_;
  EbacByObserver observer_;
  double dt_ = 0;      // s, argument of the last set_tick
  double weight_ = 0;  // of the observer
};

static_assert(Controller<Ebac>);

}  // namespace ebac
