#pragma once

#include <cmath>
#include <limits>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// The energy bound of Kim and Ryu, in a form without division, and the beta it limits.
namespace ebac {

inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// Square of the largest |F_k| for which the storage F^2/(2c) grows by no more than the port work
/// plus the energy that the damping B = b/T [N/m] surely dissipated over `dx`: F_k^2 <= F^2 + 2 c
/// (F dx + B dx^2). Never negative for c <= 2 B.
inline double energy_bound_squared(double force, double dx, double c,
                                   double damping_per_tick) EBAC_RT {
  const double square = force * force + 2 * c * dx * (force + damping_per_tick * dx);
  return square > 0 ? square : 0.0;
}

/// One tick of eq. (8), (9) as a trace shows it: beta = dF / dx and the limits it was held to.
/// Undefined (NaN, a gap in the plot) where dx = 0. Laws derive their State from it.
struct BetaTrace {
  double beta = kUndefined;      // N/m
  double beta_min = kUndefined;  // N/m
  double beta_max = kUndefined;  // N/m

  void record(double before, double after, double dx, double bound) EBAC_RT {
    if (dx == 0) {
      beta = beta_min = beta_max = kUndefined;
      return;
    }
    const double per_dx = 1 / dx;
    const double limit = dx > 0 ? bound : -bound;
    beta = (after - before) * per_dx;
    beta_max = (limit - before) * per_dx;
    beta_min = (-limit - before) * per_dx;
  }
};

template <class State>
constexpr Field<State> beta_field() {
  return {"beta", &State::beta, "N/m", "slope dF/dx taken, eq. (9); NaN where dx = 0"};
}
template <class State>
constexpr Field<State> beta_min_field() {
  return {"beta_min", &State::beta_min, "N/m", "lowest slope the energy bound allows"};
}
template <class State>
constexpr Field<State> beta_max_field() {
  return {"beta_max", &State::beta_max, "N/m", "highest slope the energy bound allows"};
}

}  // namespace ebac
