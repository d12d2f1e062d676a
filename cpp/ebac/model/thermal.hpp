#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// The i2t model of a winding: heat follows (i / continuous)^2 with one time constant; 1 is the
/// temperature that the continuous current reaches. A copper loss only: no iron, no housing.
class Thermal {
 public:
  Thermal() = default;
  Thermal(double continuous, double time) EBAC_RT : continuous_(continuous), time_(time) {}

  /// `current` [A] acted for `dt` [s]: exact for a constant one.
  void heat(double current, double dt) EBAC_RT {
    const double aim = current / continuous_;
    heat_ = aim * aim + (heat_ - aim * aim) * std::exp(-dt / time_);
  }

  /// The largest current [A] after `dt` [s] of which the heat is at most 1.
  double allowed(double dt) const EBAC_RT {
    const double decay = std::exp(-dt / time_);
    const double share = (1 - heat_ * decay) / (1 - decay);
    return continuous_ * std::sqrt(std::max(share, 0.0));
  }

  double heat() const EBAC_RT { return heat_; }

 private:
  double continuous_ = 1;  // A
  double time_ = 1;        // s
  double heat_ = 0;
};

}  // namespace ebac
