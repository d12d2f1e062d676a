#include "ebac/loop/gain_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

void GainSchedule::set_tick(double mass, double dt) EBAC_RT {
  const double w = std::sqrt(std::sqrt(12.0) * force_noise_ / (mass * count_));
  within_ = std::clamp(w * w * dt * dt / kDithered, 0.5, 1.0);
  full_ = ObserverGains::of(w, 0.5, dt);
  in_motion_ = ObserverGains::of(0.4 * w, 0.5, dt);
  at_rest_ = ObserverGains::of(0.6 * within_ * w, 0.1, dt);
  per_noise_ = 1 / force_noise_;
  resting_ = std::max(0.0, 1 - dt / kRests);
  forget_ = dt / (kMemory + dt);
}

}  // namespace ebac
