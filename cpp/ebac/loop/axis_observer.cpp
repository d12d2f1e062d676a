#include "ebac/loop/axis_observer.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

/// Values that depend on the time since the last tick and on the age of the force alone.
void AxisObserver::set_tick(double dt) EBAC_RT {
  dt_ = dt;
  per_dt_ = 1 / dt;
  damping_ = std::min(params_.damping, mass_ / dt);  // more would stop the estimate beyond rest
  per_noise_ = 1 / params_.force_noise;
  const double lag = params_.force_lag + records_.mean_age();
  motor_.set_tick(lag, dt);
  echo_.set_tick(lag, dt);
  const double w = std::sqrt(std::sqrt(12.0) * params_.force_noise / (mass_ * params_.count));
  within_ = std::clamp(w * w * dt * dt / kDithered, 0.5, 1.0);
  full_ = ObserverGains::of(w, 0.5, dt);
  in_motion_ = ObserverGains::of(0.4 * w, 0.5, dt);
  at_rest_ = ObserverGains::of(0.6 * within_ * w, 0.1, dt);
  resting_ = std::max(0.0, 1 - dt / kRests);
  noise_.set_tick(dt);
  trend_.set_tick(dt, params_.force_noise / ObserverParams::kLeastNoise);
  holding_ = dt / (kHolds + dt);
  forget_ = dt / (kMemory + dt);
}

}  // namespace ebac
