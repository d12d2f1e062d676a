#include "ebac/loop/axis_observer.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

/// Values that depend on the time since the last tick and on the age of the force alone.
void AxisObserver::set_tick(double dt) EBAC_RT {
  dt_ = dt;
  damping_ = std::min(params_.damping, mass_ / dt);  // more would stop the estimate beyond rest
  const double lag = params_.force_lag + records_.mean_age();
  motor_.set_tick(lag, dt);
  echo_.set_tick(lag, dt);
  gains_.set_tick(mass_, dt);
  held_.set_tick(dt);
  proven_.set_tick(dt);
  noise_.set_tick(dt);
  trend_.set_tick(dt, params_.force_noise / ObserverParams::kLeastNoise);
}

}  // namespace ebac
