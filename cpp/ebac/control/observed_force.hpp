#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/ebac_params.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// The force of the virtual world at the state predicted for the instant at which the command acts,
/// with a damper on the predicted velocity: F = F_e + B_v v_act, never against F_e.
///
/// Without a count of noise in the velocity, mass and delay alone bound the damper: B_v = 0.35 M /
/// ((d + 1/2) T + current_lag). The world may be shown at its whole stiffness while moving.
class ObservedForce {
 public:
  /// Without a damper where `injection` is off.
  ObservedForce(const EbacParams& law, const Timing& timing) EBAC_RT
      : show_(law.mass, kNoCount, law.current_lag, timing, law.resonance),
        half_period_(show_.half_period),
        damping_(law.injection ? show_.damping : 0.0),
        stored_at_(show_.stiffness),
        least_(kLeast* law.count) {}

  double step(const Port& port) EBAC_RT {
    watch(port);
    injected_ = 0;
    const double damped = half_period_.step(port.f_env + damping_ * port.est.v_act);
    if (port.f_env == 0) return 0;
    const double force = port.f_env > 0 ? std::max(damped, 0.0) : std::min(damped, 0.0);
    injected_ = force - port.f_env;
    return force;
  }

  void retune(const ObservedForce& next) EBAC_RT { damping_ = next.damping_; }

  double injected() const EBAC_RT { return injected_; }  // N
  double slope() const EBAC_RT { return slope_; }        // N/m, 0 out of contact

  /// Stiffness at which the last contact can have stored energy [N/m].
  double stored_at() const EBAC_RT { return stored_at_; }

 private:
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
    }
    last_env_ = port.f_env;
    last_x_ = port.est.x_act;
  }

  Injection show_;
  HalfPeriod half_period_;
  double damping_;    // N s/m
  double stored_at_;  // N/m
  double least_;      // m
  double slope_ = 0;
  double injected_ = 0;
  double last_env_ = 0;  // N
  double last_x_ = 0;    // m
};

}  // namespace ebac
