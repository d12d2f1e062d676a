#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/control/contact_estimator.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/energy_ledger.hpp"
#include "ebac/control/force_feedback.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/control/motion_guard.hpp"
#include "ebac/control/observed_force.hpp"
#include "ebac/control/recovery.hpp"
#include "ebac/control/sub_count_position.hpp"
#include "ebac/core/concepts.hpp"
#include "ebac/model/velocity.hpp"

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
/// F = F_e + B_v v at the state predicted for the instant at which the command acts, and 7 counts
/// with the velocity and the pull that are measured. Where the observer fails, the law fades to the
/// steps above in 20 ms, from the force it is at.
///
/// The design uses no property of the wall or the hand.
class Ebac {
 public:
  static constexpr std::string_view kName = "ebac";
  static constexpr std::string_view kSummary =
      "eq. (8) to (10) and (2), completed: recovery, damping, guard";
  static constexpr bool kPassive = false;  // guarded; see docs/explanation/theory.md

  /// It uses the observer's estimate where a run has one.
  static constexpr bool kObserved = true;

  using Params = EbacParams;
  using State = EbacState;

  explicit Ebac(const Params& params, const Timing& timing = {})
      : params_(checked(params, "EBAC")),
        timing_(checked(timing, "Timing")),
        show_(params.mass, params.count, params.current_lag, timing, params.resonance),
        recovery_(kPace * (params.heaviest_hand + params.mass) / show_.damping, show_.stiffness),
        loop_(params.kp, params.kd, params.filter),
        ledger_(params.damping, params.count, params.current_lag, params.reserve),
        sub_count_(params.count),
        damper_(show_),
        contact_(params.count, show_.stiffness),
        guard_(params.damping, params.mass, params.count, timing.longest()),
        observed_(params.mass, params.count, params.current_lag, timing, params.resonance),
        work_(params.count),
        observed_guard_(params.damping, params.mass, params.count / 2, timing.longest(), kKnown),
        in_flight_(timing.delay),
        asked_(std::min(timing.delay + 1, kMaxDelay)) {
    reset();
  }

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return begin(port);
    if (port.dt != dt_) set_tick(port.dt);
    const double weight = port.est.weight;
    if (weight != weight_) shift(port, weight);
    state_.clamped = false;
    state_.admitted = 1;
    double command = 0;
    if (weight < 1) {
      double wanted = by_encoder(port);
      if (weight > 0) wanted += weight * (held(observed_.step(port)) - wanted);
      command = guarded(wanted, port);
    } else {
      ledger_.take(port, work_, observed_.slope(), surface(port), asked_[0]);  // 1
      command = observed_guarded(by_observer(port), port);
    }
    finish(command, port);
    return command;
  }

  void retune(const Ebac& next) EBAC_RT {
    params_ = next.params_;
    loop_.retune(params_.kp, params_.kd, params_.filter);
    recovery_ = next.recovery_;
  }
  void reset() EBAC_RT {
    loop_.reset();
    damper_.reset();
    ledger_ = EnergyLedger(params_.damping, params_.count, params_.current_lag, params_.reserve);
    in_flight_ = CommandsInFlight(timing_.delay);
    asked_ = CommandsInFlight(asked_.size());
    readings_.clear();
    state_ = {};
    state_.energy = params_.reserve;
    contact_ = ContactEstimator(params_.count, show_.stiffness);
    observed_ =
        ObservedForce(params_.mass, params_.count, params_.current_lag, timing_, params_.resonance);
    work_ = ObservedWork(params_.count);
    time_ = dt_ = ratio_ = weight_ = recovered_ = command_ = world_v_ = 0;
  }

  const State& state() const EBAC_RT { return state_; }
  double starved() const EBAC_RT { return state_.starved; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  // Chosen on a grid of 60 hands and 36 cells of delay, damping and stiffness; `ebac study` runs it.
  static constexpr double kPace = 2.2;    // recovery against what B_v damps, for the heaviest hand
  static constexpr double kFloor = 0.5;   // of c_h: slope that continuity always allows
  static constexpr double kYield = 0.01;  // s, F_d follows a command the guard holds back
  static constexpr int kWindow = 16;      // samples, velocity the guard counts with
  static constexpr double kShort = 0.5;   // of a command: less is starved
  static constexpr double kFed = 10;      // s by which `starved` falls in a second
  static constexpr double kSensor = 0.5;  // N, error of the force sensor the guard counts with
  static constexpr double kKnown = 0.5;   // of a jump: the velocity is that at the interval's start

  /// Values that depend on the time since the last tick alone.
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    ledger_.set_tick(dt);
    damper_.set_tick(dt);
  }

  double begin(const Port& port) EBAC_RT {
    sub_count_.start(port.x);
    readings_.push(port.x, 0);
    work_.start(port);
    world_v_ = port.world_v;
    return 0;
  }

  /// Way of the world's surface over the last interval [m].
  double surface(const Port& port) EBAC_RT {
    const double mean = 0.5 * (world_v_ + port.world_v);
    world_v_ = port.world_v;
    return mean * port.dt;
  }

  /// What the ledger has for the guard: a surface that yields takes its share of the energy until
  /// the command has acted.
  double to_spend(double wanted, const Port& port) const EBAC_RT {
    const double yields = std::copysign(port.world_v, port.world_v * wanted);
    if (!(yields > 0)) return ledger_.energy();
    const double time = (timing_.delay + 1) * port.dt + params_.current_lag;
    return ledger_.energy() - in_flight_.largest_with(wanted) * yields * time;
  }

  /// The observer comes or goes: what takes over starts where the other is. The encoder's part
  /// needs a larger reserve.
  void shift(const Port& port, double weight) EBAC_RT {
    if (weight_ >= 1 && weight < 1) {
      sub_count_.start(port.x);
      damper_.reset();
      loop_.reset();
      readings_.clear();
      contact_ = ContactEstimator(params_.count, show_.stiffness);
      ratio_ = 0;
    }
    if (weight_ < 1 && weight >= 1) work_.start(port);
    weight_ = weight;
  }

  /// Steps 1 to 6 on the encoder's readings.
  double by_encoder(const Port& port) EBAC_RT {
    recovered_ = 0;
    ledger_.lend(params_.reserve);
    ledger_.take(port.f_applied, sub_count_.step(port.x, port.dt), port.dx, surface(port),
                 asked_[0]);  // 1
    const double damping = damper_.step(port.dx);
    readings_.push(port.x, time_ += port.dt);
    contact_.watch(port, sub_count_.direction());
    state_.slope = contact_.slope();
    if (port.f_env == 0) {
      release();  // 4
    } else if (port.dx != 0) {
      move(port);  // 2
    } else if (params_.recovery) {
      recover(port);  // 3
    }
    state_.f_d = held(state_.f_d);
    return port.f_env == 0 ? 0.0 : complete(port, damping);  // 5, 6
  }

  /// The same on the observer's estimate: nothing is left for eq. (8) to (10) to bound or recover.
  double by_observer(const Port& port) EBAC_RT {
    ledger_.lend(params_.observed_reserve);
    const double wanted = observed_.step(port);
    state_.slope = observed_.slope();
    state_.f_d = held(port.f_env);
    state_.injected = observed_.injected();
    state_.record(0, 0, 0, 0);
    return held(wanted);
  }

  double held(double force) const EBAC_RT {
    return std::clamp(force, -params_.peak_force, params_.peak_force);
  }

  void release() EBAC_RT {
    state_.f_d = 0;
    ratio_ = 0;
    state_.record(0, 0, 0, 0);
  }

  void move(const Port& port) EBAC_RT {
    const double dx = port.dx;
    const double before = state_.f_d;
    double rise = port.f_env - before;  // eq. (9): beta dx
    const bool releasing = before * dx < 0 && std::abs(port.f_env) < std::abs(before);
    if (params_.continuity && !releasing) {
      const double least = kFloor * show_.stiffness * std::abs(dx);  // the floor
      const double grown = params_.growth * ratio_ * dx;             // eq. (10), rows 3 and 4,
      const double decayed = params_.decay * ratio_ * dx;            // sorted
      rise =
          std::clamp(rise, std::min({grown, decayed, -least}), std::max({grown, decayed, least}));
    }
    const double bound = std::abs(before + show_.stiffness * dx);  // eq. (10), rows 1 and 2: last
    state_.f_d = std::clamp(before + rise, -bound, bound);         // eq. (8)
    state_.clamped = state_.f_d != before + rise;
    state_.record(before, state_.f_d, dx, bound);
    ratio_ = state_.beta;
  }

  void recover(const Port& port) EBAC_RT {
    const double slope = contact_.slope_at_rest();
    const double open = 0.5 * slope * params_.count;  // uncertainty of a reading
    const double off = port.f_env - state_.f_d;
    const double sure = std::max(off - open, 0.0) + std::min(off + open, 0.0);
    const double change = sure * recovery_.share(slope, contact_.pace(), port.dt);
    ledger_.charge_unseen(std::abs(change));
    recovered_ = change;
    state_.f_d += change;
    state_.record(0, 0, 0, 0);
  }

  double complete(const Port& port, double damping) EBAC_RT {
    double desired = state_.f_d;
    state_.injected = 0;
    if (params_.injection) {
      desired += damping;
      desired = port.f_env > 0 ? std::max(desired, 0.0) : std::min(desired, 0.0);  // never sticks
      state_.injected = desired - state_.f_d;
    }
    const double total = desired + loop_.step(desired, port.f_meas, port.dt);  // eq. (2)
    return held(total);
  }

  double guarded(double wanted, const Port& port) EBAC_RT {
    if (!params_.guard) return wanted;
    const double energy = to_spend(wanted, port);
    const double step = std::abs(port.dx) + params_.count;  // no window slopes by more than this
    if (guard_.surely_admits(wanted, in_flight_, ledger_.lagged(), energy, step, params_.pull)) {
      return wanted;
    }
    const double v = adaptive_slope(readings_, kWindow, params_.count);
    const double command =
        guard_.admit(wanted, in_flight_, ledger_.lagged(), energy, v, params_.pull);
    if (command != wanted) {
      state_.clamped = true;
      state_.admitted = command / wanted;
      take_back(command);
      const double size = std::abs(command);
      if (std::abs(state_.f_d) > size) {
        state_.f_d += (std::copysign(size, state_.f_d) - state_.f_d) * port.dt / (kYield + port.dt);
      }
    }
    return command;
  }

  /// A force that the guard does not give is not charged.
  void take_back(double command) EBAC_RT {
    const double asked = std::abs(recovered_);
    const double given = std::copysign(1.0, recovered_) * (command - command_);
    ledger_.charge_unseen(std::clamp(given, 0.0, asked) - asked);
  }

  /// With the velocity of the observer, half a count, and the pull that the force sensor shows: a
  /// hand may vanish at any time, but its pull grows no faster than declared.
  double observed_guarded(double wanted, const Port& port) EBAC_RT {
    if (!params_.guard || wanted == 0) return wanted;
    const double shown = std::max(0.0, wanted > 0 ? -port.f_meas : port.f_meas);
    const double grown = params_.pull_rate * (timing_.delay + 1) * port.dt;
    const double pull = std::min(params_.pull, shown + kSensor + grown);
    const double v = port.est.v;
    const double energy = to_spend(wanted, port);
    if (observed_guard_.surely_admits(wanted, in_flight_, ledger_.lagged(), energy,
                                      std::abs(v) * port.dt, pull)) {
      return wanted;
    }
    const double command =
        observed_guard_.admit(wanted, in_flight_, ledger_.lagged(), energy, v, pull);
    if (command != wanted) {
      state_.clamped = true;
      state_.admitted = command / wanted;
    }
    return command;
  }

  void finish(double command, const Port& port) EBAC_RT {
    if (port.f_env == 0) {
      loop_.reset();
      state_.injected = 0;
    }
    command_ = command;
    in_flight_.push(command);
    if (port.world_v != 0) asked_.push(port.f_env);
    ledger_.leak(command, weight_ < 1 ? contact_.stored_at() : observed_.stored_at());
    state_.energy = ledger_.energy();
    const double longer = state_.admitted < kShort ? port.dt : -kFed * port.dt;
    state_.starved = std::max(0.0, state_.starved + longer);
  }

  Params params_;
  Timing timing_;
  Injection show_;  // stiffness and damping that the device can render in motion
  Recovery recovery_;
  ForceFeedback loop_;
  EnergyLedger ledger_;
  SubCountPosition sub_count_;
  Damper damper_;
  ContactEstimator contact_;
  MotionGuard guard_;
  ObservedForce observed_;
  ObservedWork work_;
  MotionGuard observed_guard_;
  CommandsInFlight in_flight_;
  CommandsInFlight asked_;  // N, of the world: for the commands in flight and the one that acts
  Readings readings_{};
  State state_{};
  double dt_ = 0;         // s, argument of the last set_tick
  double time_ = 0;       // s
  double ratio_ = 0;      // N/m, beta(t-1)
  double weight_ = 0;     // of the observer, in the last tick
  double recovered_ = 0;  // N, change of F_d by recovery in this tick
  double command_ = 0;    // N, of the last tick
  double world_v_ = 0;    // m/s, of the last tick
};

static_assert(Controller<Ebac>);

}  // namespace ebac
