#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ebac/control/dynamic_stiffness.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/control/static_slope.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// The force of the virtual world at the state predicted for the instant at which the command acts,
/// with a damper on the predicted velocity: F = F_e + B_v v_act, never against F_e. Of F_e, small
/// fast changes are shown softer (`DynamicStiffness`) while account and allowance pay, stiffer where
/// one of them is spent.
///
/// The allowance is charged with the work of what is shown beyond the world's force, F - F_e, over the
/// estimated motion, and never exceeds the reserve. So the softer changes give out less than a reserve
/// in any window of time, however much energy the account holds.
///
/// Without a count of noise in the velocity, mass and delay alone bound the damper: B_v = 0.55 M /
/// ((d + 0.8) T + current_lag). Twice as much loses walls where the observer is told half of the
/// mass or a wrong lag of the sensor. On a soft world, of slope K, it is at most sqrt(K (M + heaviest
/// hand)), half of critical for that hand: more would only make it slow. Until a contact has shown its
/// slope, K is what its first force over the way of that tick shows at least. Where the world has a
/// damping B of its own, B and the damper are at most 1.5 B_v together. The world may be shown at its
/// whole stiffness while moving.
class ObservedForce {
 public:
  /// Without a damper where `injection` is off.
  ObservedForce(const EbacParams& law, const Timing& timing) EBAC_RT
      : show_(law.mass, Injection::kNoCount, law.current_lag + kSpare * timing.dt, timing,
              law.resonance, kPhaseLag),
        dynamic_(law.fast_stiffness, law.count),
        half_period_(show_.half_period),
        damping_(law.injection ? show_.damping : 0.0),
        stiffest_(2 * damping_ * damping_ / law.mass),
        heaviest_(law.mass + law.heaviest_hand),
        reserve_(law.observed_reserve),
        per_half_(reserve_ > 0 ? 2 / reserve_ : 0.0),
        allowance_(reserve_),
        stored_at_(show_.stiffness),
        slope_(kLeast* law.count) {}

  /// Takes the state and the force of the world. Apart from `force`, so that the account of the interval that ended is
  /// kept meanwhile: one waits for the other only at its end.
  void meet(const Port& port) EBAC_RT {
    watch(port);
    dynamic_.follow(port.f_env, slope_.value(), port.dt);
  }

  /// `energy` is what the account holds [J].
  double force(const Port& port, double energy) EBAC_RT {
    injected_ = 0;
    shown_ = dynamic_.shown(port.f_env, softer(port.f_env, energy));
    const double bears = std::max(kMost * damping_ - slope_.damping(), 0.0);
    const double damper = std::min(std::min(damping_, enough()), bears);
    const double damped = half_period_.step(shown_ + damper * port.est.v_act);
    beyond_ = 0;
    if (port.f_env == 0) return 0;
    const double force = port.f_env > 0 ? std::max(damped, 0.0) : std::min(damped, 0.0);
    injected_ = force - shown_;
    beyond_ = force - port.f_env;
    return force;
  }

  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    slope_.shift(change);
    dynamic_.shift(change);
  }

  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    slope_.scale(by);
    dynamic_.scale(by);
    if (slope_.value() > 0) know_slope();
  }

  /// Nothing is known of the contact.
  void forget() EBAC_RT {
    slope_.forget();
    dynamic_.forget();
    beyond_ = 0;
    half_period_ = HalfPeriod(show_.half_period);
  }

  void retune(const ObservedForce& next) EBAC_RT {
    dynamic_.retune(next.dynamic_);
    damping_ = next.damping_;
    stiffest_ = next.stiffest_;
    heaviest_ = next.heaviest_;
    if (slope_.value() > 0) know_slope();
  }

  double shown() const EBAC_RT { return shown_; }          // N, of the world
  double injected() const EBAC_RT { return injected_; }    // N
  double slope() const EBAC_RT { return slope_.value(); }  // N/m, 0 out of contact

  /// Energy that a spring of the world's slope gives back from `force` [J]; 0 where no slope is known.
  double stored(double force) const EBAC_RT {
    return slope_.value() > 0 ? 0.5 * force * force * per_slope_ : 0.0;
  }

  /// Stiffness at which the last contact can have stored energy [N/m].
  double stored_at() const EBAC_RT { return stored_at_; }

 private:
  static constexpr double kPhaseLag = 0.55;  // rad of delay at w
  static constexpr double kMost = 1.5;       // of B_v, with the world's damping
  static constexpr double kSpare = 0.3;      // ticks of delay, for facts that are wrong
  static constexpr double kLeast = 0.02;     // counts: a smaller motion shows no slope

  /// The estimate that fades in or out is not where the world was met.
  void watch(const Port& port) EBAC_RT {
    if (port.est.weight < 1) return;
    allowance_ = std::min(allowance_ + beyond_ * port.est.dx, reserve_);
    const double surface = port.world_v * port.dt;
    if (slope_.step(port.f_env, port.est.x_act, port.est.v_act, surface)) know_slope();
  }
  /// Damping that is enough for the heaviest hand on this world [N s/m].
  double enough() const EBAC_RT {
    if (slope_.value() > 0) return enough_;
    return std::min(enough_, std::sqrt(slope_.at_least() * heaviest_));
  }
  void know_slope() EBAC_RT {
    per_slope_ = 1 / slope_.value();
    stored_at_ = std::min(show_.stiffness, slope_.value());
    enough_ = std::sqrt(slope_.value() * heaviest_);
  }

  /// Share by which small fast changes are softer: all while the whole allowance is left and the
  /// account holds as much beyond what a spring would, none at half of that, and stiffer below, as far
  /// as the damper bears it.
  double softer(double force, double energy) const EBAC_RT {
    if (slope_.value() <= 0 || reserve_ <= 0) return 1;
    const double left = std::min(allowance_, energy - stored(force));
    const double share = left * per_half_ - 1;
    if (share >= 0) return std::min(share, 1.0);
    const double borne = std::clamp(stiffest_ * per_slope_ - 1, 0.0, 1.0);
    return std::max(share, -borne);
  }

  Injection show_;
  DynamicStiffness dynamic_;
  HalfPeriod half_period_;
  double damping_;    // N s/m
  double stiffest_;   // N/m, at which the damper is 0.35 of critical for the device alone
  double heaviest_;   // kg, device and hand
  double reserve_;    // J
  double per_half_;   // 1/J, of half of it
  double allowance_;  // J, of the reserve, for softer changes
  double stored_at_;  // N/m
  StaticSlope slope_;
  double per_slope_ = 0;                                     // m/N
  double enough_ = std::numeric_limits<double>::infinity();  // N s/m, on the last world
  double shown_ = 0;                                         // N
  double injected_ = 0;                                      // N
  double beyond_ = 0;  // N, of the last command, what the world did not ask for
};

}  // namespace ebac
