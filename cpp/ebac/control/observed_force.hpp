#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ebac/control/dynamic_stiffness.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// The force of the virtual world at the state predicted for the instant at which the command acts,
/// with a damper on the predicted velocity: F = F_e + B_v v_act, never against F_e. Of F_e, small
/// fast changes are shown softer (`DynamicStiffness`).
///
/// Without a count of noise in the velocity, mass and delay alone bound the damper: B_v = 0.5 M /
/// ((d + 0.8) T + current_lag). Twice as much loses walls where the observer is told half of the
/// mass or a wrong lag of the sensor. On a soft world, of slope K, it is at most sqrt(K (M + heaviest
/// hand)), half of critical for that hand: more would only make it slow. The world may be shown at its
/// whole stiffness while moving.
class ObservedForce {
 public:
  /// Without a damper where `injection` is off.
  ObservedForce(const EbacParams& law, const Timing& timing) EBAC_RT
      : show_(law.mass, kNoCount, law.current_lag + kSpare * timing.dt, timing, law.resonance,
              kPhaseLag),
        dynamic_(law.fast_stiffness),
        half_period_(show_.half_period),
        damping_(law.injection ? show_.damping : 0.0),
        heaviest_(law.mass + law.heaviest_hand),
        stored_at_(show_.stiffness),
        least_(kLeast* law.count) {}

  double step(const Port& port) EBAC_RT {
    watch(port);
    injected_ = 0;
    shown_ = dynamic_.step(port.f_env, slope_, port.dt);
    const double damped = half_period_.step(shown_ + std::min(damping_, enough_) * port.est.v_act);
    if (port.f_env == 0) return 0;
    const double force = port.f_env > 0 ? std::max(damped, 0.0) : std::min(damped, 0.0);
    injected_ = force - shown_;
    return force;
  }

  void retune(const ObservedForce& next) EBAC_RT {
    dynamic_.retune(next.dynamic_);
    damping_ = next.damping_;
  }

  double shown() const EBAC_RT { return shown_; }        // N, of the world
  double injected() const EBAC_RT { return injected_; }  // N
  double slope() const EBAC_RT { return slope_; }        // N/m, 0 out of contact

  /// Stiffness at which the last contact can have stored energy [N/m].
  double stored_at() const EBAC_RT { return stored_at_; }

 private:
  static constexpr double kPhaseLag = 0.5;   // rad of delay at w
  static constexpr double kSpare = 0.3;      // ticks of delay, for facts that are wrong
  static constexpr double kNoCount = 1e-12;  // m: the velocity has no noise of counts
  static constexpr double kLeast = 0.02;     // counts: a smaller motion shows no slope
  static constexpr double kForget = 0.02;    // per tick, of a slope steeper than the last

  void watch(const Port& port) EBAC_RT {
    const double dx = std::abs(port.est.x_act - last_x_);
    if (port.f_env == 0) {
      slope_ = 0;
    } else if (dx > least_ && last_env_ != 0) {
      const double seen = std::abs(port.f_env - last_env_) / dx;
      slope_ = seen > slope_ ? seen : slope_ + kForget * (seen - slope_);
      stored_at_ = std::min(show_.stiffness, slope_);
      enough_ = std::sqrt(slope_ * heaviest_);
    }
    last_env_ = port.f_env;
    last_x_ = port.est.x_act;
  }

  Injection show_;
  DynamicStiffness dynamic_;
  HalfPeriod half_period_;
  double damping_;    // N s/m
  double heaviest_;   // kg, device and hand
  double stored_at_;  // N/m
  double least_;      // m
  double slope_ = 0;
  double enough_ = std::numeric_limits<double>::infinity();  // N s/m, on the last world
  double shown_ = 0;
  double injected_ = 0;
  double last_env_ = 0;  // N
  double last_x_ = 0;    // m
};

}  // namespace ebac
