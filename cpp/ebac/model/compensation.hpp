#pragma once

#include <algorithm>
#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// tau_static of eq. (2): gravity, friction and inertia given back to the hand, referred to the
/// handle.
///
/// Friction and inertia compensation spend the damping that the energy laws rely on. The push for
/// friction never exceeds `friction`, so that real Coulomb friction of at least this size still
/// pays for it, whatever the delay; a deficit counts against the viscous damping with the slope
/// (friction - coulomb)/friction_speed. Inertia given back through a filter is at no frequency and
/// no delay more than a damper of inertia/inertia_lag.
struct Compensation {
  double gravity_mass = 0;       // kg
  double friction = 0;           // N
  double friction_speed = 0.02;  // m/s
  double inertia = 0;            // kg
  double inertia_lag = 5e-3;     // s

  bool active() const EBAC_RT { return gravity_mass > 0 || friction > 0 || inertia > 0; }

  /// Force that helps a motion of speed `v` and acceleration `a`; as every force, positive resists
  /// +x.
  double force(double v, double a) const EBAC_RT {
    return -friction * std::clamp(v / friction_speed, -1.0, 1.0) - inertia * a;
  }

  /// Lower bound of the viscous damping that is left, given the device's real damping and Coulomb
  /// friction.
  double damping_left(double damping, double coulomb) const EBAC_RT {
    return damping - std::max(0.0, friction - coulomb) / friction_speed - inertia / inertia_lag;
  }

  double mass_left(double mass) const EBAC_RT { return mass - inertia; }

  static constexpr auto fields() {
    using F = Field<Compensation>;
    return std::array{
        F{"gravity_mass", &Compensation::gravity_mass, "kg", "mass whose weight is carried", 0,
          100},
        F{"friction", &Compensation::friction, "N", "Coulomb friction given back", 0, 100},
        F{"friction_speed", &Compensation::friction_speed, "m/s",
          "speed at which friction is given back in full", 1e-4, 10},
        F{"inertia", &Compensation::inertia, "kg", "mass given back", 0, 100},
        F{"inertia_lag", &Compensation::inertia_lag, "s", "filter on the acceleration it uses",
          1e-4, 1},
    };
  }
};

}  // namespace ebac
