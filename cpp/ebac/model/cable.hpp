#pragma once

#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/model/mechanics.hpp"

namespace ebac {

/// The cable between rotor and lever, referred to the handle: spring and damper, with play between
/// two flanks. `gap` is the lead of the lever over the rotor [m], `rate` its rate [m/s].
///
/// A flank pushes and never pulls: the lever leaves it as soon as spring and damper together would
/// pull. Without backlash the cable is preloaded, and the two flanks are one.
struct Cable {
  double stiffness;  // N/m
  double damping;    // N s/m
  double half_play;  // m

  explicit Cable(const Mechanics& m)
      : stiffness(m.cable_stiffness), damping(m.cable_damping), half_play(m.backlash / 2) {}

  bool plays() const EBAC_RT { return half_play > 0; }

  /// Force on the rotor, towards +x, on flank -1 or +1.
  double force(double gap, double rate, double flank) const EBAC_RT {
    return stiffness * (gap - flank * half_play) + damping * rate;
  }

  /// The flank that pushes, or 0 inside the play.
  double flank(double gap, double rate) const EBAC_RT {
    if (!plays()) return 1;
    const double side = std::copysign(1.0, gap);
    return std::abs(gap) >= half_play && side * force(gap, rate, side) > 0 ? side : 0.0;
  }

  /// Not negative while `flank` is the right one; only the sign has a meaning.
  double margin(double gap, double rate, double flank) const EBAC_RT {
    if (!plays()) return 1;
    if (flank != 0) return flank * force(gap, rate, flank);
    if (std::abs(gap) < half_play) return half_play - std::abs(gap);
    const double side = std::copysign(1.0, gap);
    return -side * force(gap, rate, side);
  }
};

}  // namespace ebac
